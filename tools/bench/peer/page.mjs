// Draws /model.glb as bolt-bench does and posts the time of each frame: 4 samples per pixel, one shadow map of 2048 pixels,
// environment light and a lamp. A frame ends when one of its pixels has been read back, because commands run asynchronously.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';

const post = (path, body) => fetch(path, { method: 'POST', body });

async function measure() {
    const options = await (await fetch('/options.json')).json();
    const [width, height] = options.size;
    const start = performance.now();
    const renderer = new THREE.WebGLRenderer({ antialias: true, powerPreference: 'high-performance' });
    renderer.setPixelRatio(1);
    renderer.setSize(width, height);
    renderer.toneMapping = THREE.ACESFilmicToneMapping;
    renderer.shadowMap.enabled = true;
    renderer.shadowMap.type = THREE.PCFShadowMap;
    document.body.appendChild(renderer.domElement);
    const gl = renderer.getContext();
    const info = gl.getExtension('WEBGL_debug_renderer_info');

    const scene = new THREE.Scene();
    scene.background = new THREE.Color(0.32, 0.34, 0.36);
    const generator = new THREE.PMREMGenerator(renderer);
    scene.environment = generator.fromScene(new RoomEnvironment()).texture;
    const gltf = await new GLTFLoader().loadAsync('/model.glb');
    const loaded = performance.now();
    let triangles = 0;
    gltf.scene.traverse((object) => {
        if (!object.isMesh) return;
        object.castShadow = object.receiveShadow = true;
        triangles += (object.geometry.index ?? object.geometry.attributes.position).count / 3;
    });
    scene.add(gltf.scene);
    const sphere = new THREE.Box3().setFromObject(gltf.scene).getBoundingSphere(new THREE.Sphere());
    const lamp = new THREE.DirectionalLight(0xffffff, 1.6);
    lamp.position.copy(sphere.center).addScaledVector(new THREE.Vector3(-0.45, 1, 0.55).normalize(), 2 * sphere.radius);
    lamp.target.position.copy(sphere.center);
    lamp.castShadow = true;
    lamp.shadow.mapSize.set(2048, 2048);
    Object.assign(lamp.shadow.camera, { left: -sphere.radius, right: sphere.radius, top: sphere.radius,
                                        bottom: -sphere.radius, near: sphere.radius, far: 3 * sphere.radius });
    scene.add(lamp, lamp.target);
    const camera = new THREE.PerspectiveCamera(options.fov_deg, width / height, 0.05, 100);
    camera.position.fromArray(options.eye);
    camera.lookAt(new THREE.Vector3().fromArray(options.target));

    const pixel = new Uint8Array(4);
    const frame = () => {
        const before = performance.now();
        renderer.render(scene, camera);
        gl.finish();
        gl.readPixels(width / 2, height / 2, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
        return performance.now() - before;
    };
    const first = frame();
    // CPU time of all processes of the browser, in ms.
    const cpu = async () => Number(await (await fetch('/cpu')).text());
    const series = async (keep) => {
        renderer.shadowMap.autoUpdate = !keep;
        frame();
        const before = await cpu();
        const times = Array.from({ length: options.frames }, frame);
        return { times, cpu: (await cpu() - before) / options.frames };
    };
    const each = await series(false), kept = await series(true);
    const result = {
        three: THREE.REVISION,
        renderer: info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : gl.getParameter(gl.RENDERER),
        samples: gl.getParameter(gl.SAMPLES),
        size: [gl.drawingBufferWidth, gl.drawingBufferHeight],
        triangles, calls: renderer.info.render.calls,
        load_ms: loaded - start, first_frame_ms: first,
        shadow_each_frame_ms: each.times, shadow_kept_ms: kept.times,
        shadow_each_frame_cpu_ms: each.cpu, shadow_kept_cpu_ms: kept.cpu,
    };
    frame();
    const png = await new Promise((done) => renderer.domElement.toBlob(done));
    await post('/picture', png);
    return result;
}

measure().then((result) => post('/result', JSON.stringify(result)),
               (problem) => post('/result', JSON.stringify({ problem: String(problem?.stack ?? problem) })));
