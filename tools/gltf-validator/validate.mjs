// Runs the Khronos glTF validator on the files of the command line and prints its messages for each file as JSON:
// [{ "file", "messages": [{ "severity": 0 error | 1 warning, "code", "message", "pointer" }] }]
import { readFile } from 'node:fs/promises';
import { dirname, resolve } from 'node:path';
import { validateBytes } from 'gltf-validator';

async function validate(file) {
    try {
        const report = await validateBytes(new Uint8Array(await readFile(file)), {
            uri: file,
            maxIssues: 100,
            externalResourceFunction: async (uri) =>
                new Uint8Array(await readFile(resolve(dirname(file), decodeURIComponent(uri)))),
        });
        const messages = report.issues.messages
            .filter((issue) => issue.severity <= 1)
            .map(({ severity, code, message, pointer }) => ({ severity, code, message, pointer: pointer ?? '' }));
        const omitted = report.issues.numErrors + report.issues.numWarnings - messages.length;
        if (omitted > 0)
            messages.push({ severity: 0, code: 'TRUNCATED', message: `${omitted} more are not shown.`, pointer: '' });
        return { file, messages };
    } catch (problem) {
        return { file, messages: [{ severity: 0, code: 'NOT_GLTF', message: String(problem), pointer: '' }] };
    }
}

const reports = [];
for (const file of process.argv.slice(2)) reports.push(await validate(file));
console.log(JSON.stringify(reports));
