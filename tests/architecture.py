#!/usr/bin/env python3
"""Checks includes and links against the dependencies that the CMakeLists.txt files declare, and that no two types share a name.

usage: architecture.py SOURCES [--list]

A folder with a CMakeLists.txt is a unit. Its sources may include headers of its own and of the units that its libraries and
programs link, directly or through others. Units of one layer may link only units of that layer that come before them in the
order of add_subdirectory, so there is no cycle; a layer may use only the layers below it. A type at namespace scope has a name of its own, even in another
namespace, so that a name has one meaning; SAME_SENSE lists the exceptions. --list prints the graph.
Exit code: 0 graph and names are as declared, 1 they are not.
"""
import os
import re
import sys
import tempfile

# A layer and the layers that it may use.
LAYERS = {
    "engine": {"engine", "shaders"},
    "haptics": {"haptics", "engine/base"},
    "content": {"content", "haptics", "engine/base"},
    "game": {"game", "content", "haptics", "engine"},
    "tools": {"tools", "game", "content", "haptics", "engine"},
}
# Simulated trainees use the trainer as people do: only programs may need them.
USERS_ONLY = {"game/trainees": {"game/cli", "tools"}}

# Types that mean the same in each file that defines them.
SAME_SENSE = {"BoundingBox", "Clock", "CloseFile", "DisplayFindings", "ErrorOfBoost", "Finish", "Json", "ModelLimits", "ProfilePoint", "TriangleIndices",
              "UniqueHandle"}
# C types of a maker's library, which its emulation must define under their names.
FOREIGN_NAMES = {"Error"}


def read(path):
    with open(path, encoding="utf-8") as file:
        return re.sub(r"(?m)^\s*#.*$", "", file.read())


def subfolders(root, folder):
    """Units below `folder`, in the order of add_subdirectory."""
    path = os.path.join(root, folder, "CMakeLists.txt")
    if not os.path.exists(path):
        return []
    text = read(path)
    found = []
    if re.search(r"house_(library|program)\(", text):
        found.append(folder)
    for name in re.findall(r"add_subdirectory\(([^)\s]+)\)", text):
        found += subfolders(root, os.path.normpath(os.path.join(folder, name)))
    return found


def targets(root, folder):
    """name -> linked names, of every library and program that `folder` defines."""
    text = read(os.path.join(root, folder, "CMakeLists.txt"))
    found = {}
    for name, words in re.findall(r"house_(?:library|program)\(\s*([\w-]+)([^)]*)\)", text):
        links, into = [], False
        for word in words.split():
            if word in ("LINK", "PRIVATE"):
                into = True
            elif word in ("SOURCES", "HOT", "COLD", "SEPARATE"):
                into = False
            elif into:
                links.append(word)
        found[name] = links
    for name, words in re.findall(r"target_link_libraries\(\s*([\w-]+)([^)]*)\)", text):
        found.setdefault(name, []).extend(w for w in words.split() if w not in ("PRIVATE", "PUBLIC", "INTERFACE"))
    return found


def unit_of(path, units):
    """The innermost unit that holds the file, or None."""
    folder = os.path.dirname(path)
    while folder and folder not in units:
        folder = os.path.dirname(folder)
    return folder or None


def includes(root, unit, units):
    """(file, line, header) of every include of a house header in the unit."""
    for folder, _, names in os.walk(os.path.join(root, unit)):
        relative = os.path.relpath(folder, root)
        for name in sorted(names):
            path = os.path.join(relative, name)
            if not name.endswith((".hpp", ".cpp", ".in")) or unit_of(path, units) != unit:
                continue
            with open(os.path.join(root, path), encoding="utf-8") as file:
                for number, line in enumerate(file, 1):
                    match = re.match(r'#include +"((?:engine|haptics|content|game|tools|shaders|tests)/[^"]+)"', line)
                    if match:
                        yield path, number, match.group(1)


def layer_allows(layer, unit):
    return any(unit == allowed or unit.startswith(allowed + "/") for allowed in LAYERS[layer])


def names_twice(root):
    """A fault for each name of a type or an alias that two files define. A header and its .cpp count as one: a class may keep parts in it."""
    files = {}
    for layer in LAYERS:
        for folder, _, names in os.walk(os.path.join(root, layer)):
            for name in sorted(n for n in names if n.endswith((".hpp", ".cpp"))):
                path = os.path.relpath(os.path.join(folder, name), root)
                with open(os.path.join(root, path), encoding="utf-8") as file:
                    for found in re.findall(r"(?m)^(?:struct|class|enum class|using) ([A-Z]\w*) *(?:final *)?[:={][^:]", file.read()):
                        files.setdefault(found, {}).setdefault(os.path.splitext(path)[0], path)
    return [f"{name}: defined in {' and '.join(sorted(f.values()))}; expected two names for two meanings"
            for name, f in sorted(files.items()) if len(f) > 1 and name not in SAME_SENSE | FOREIGN_NAMES]


def check(root):
    """The graph (unit -> units it links) and the list of faults."""
    order = [u for u in subfolders(root, ".") if u.split("/")[0] in LAYERS]
    units = {u: targets(root, u) for u in order}
    owner = {name: unit for unit, defined in units.items() for name in defined}
    graph = {u: sorted({owner[l] for links in units[u].values() for l in links if l in owner} - {u}) for u in order}
    faults = []
    for unit, used in graph.items():
        layer = unit.split("/")[0]
        for other in used:
            if not layer_allows(layer, other):
                faults.append(f"{unit}: links {other}; expected one of {', '.join(sorted(LAYERS[layer]))}")
            elif other.split("/")[0] == layer and order.index(other) > order.index(unit):
                faults.append(f"{unit}: links {other}, which comes after it; expected a folder above it in add_subdirectory")
            elif other in USERS_ONLY and not {unit, layer} & USERS_ONLY[other]:
                faults.append(f"{unit}: links {other}; expected only programs to need it")
    reach = {}
    for unit in order:
        seen, waiting = {unit}, [unit]
        while waiting:
            for other in graph[waiting.pop()]:
                if other not in seen:
                    seen.add(other)
                    waiting.append(other)
        reach[unit] = seen
    for unit in order:
        for path, line, header in includes(root, unit, units):
            other = unit_of(header, units)
            if header.startswith("shaders/"):
                continue
            if other is None or not layer_allows(unit.split("/")[0], other):
                faults.append(f"{path}:{line}: includes {header}, which is not below {unit.split('/')[0]}")
            elif other not in reach[unit]:
                faults.append(f"{path}:{line}: includes {header}; expected {unit}/CMakeLists.txt to link {other}")
    return graph, faults + names_twice(root)


def self_test():
    """Verifies that check() finds faults which are planted in a small tree."""
    def tree(files):
        root = tempfile.mkdtemp()
        for path, text in files.items():
            os.makedirs(os.path.join(root, os.path.dirname(path)), exist_ok=True)
            with open(os.path.join(root, path), "w", encoding="utf-8") as file:
                file.write(text)
        return root

    top = {"CMakeLists.txt": "add_subdirectory(engine/base)\nadd_subdirectory(haptics/joint)\nadd_subdirectory(haptics/servo)\n",
           "engine/base/CMakeLists.txt": "house_library(base SOURCES a.cpp)",
           "haptics/joint/CMakeLists.txt": "house_library(joint SOURCES a.cpp LINK base)",
           "haptics/servo/CMakeLists.txt": "house_library(servo SOURCES a.cpp LINK joint)",
           "haptics/servo/a.cpp": '#include "haptics/joint/a.hpp"\n#include "engine/base/a.hpp"\n'}
    assert not check(tree(top))[1], check(tree(top))[1]
    upward = {**top, "engine/base/a.hpp": '#include "haptics/joint/a.hpp"\n'}
    unlinked = {**top, "haptics/servo/CMakeLists.txt": "house_library(servo SOURCES a.cpp LINK base)"}
    backward = {**top, "haptics/joint/CMakeLists.txt": "house_library(joint SOURCES a.cpp LINK base servo)"}
    twin = {**top, "engine/base/a.hpp": "struct Jaw {\n};\n", "haptics/joint/a.hpp": "struct Jaw : Head {\n};\n"}
    for name, planted in (("upward include", upward), ("include without a link", unlinked), ("link to a later folder", backward),
                          ("name with two meanings", twin)):
        assert check(tree(planted))[1], f"the check misses an {name}"


def main():
    root = sys.argv[1]
    self_test()
    graph, faults = check(root)
    if "--list" in sys.argv:
        for unit, used in graph.items():
            print(f"{unit}: {' '.join(used)}")
    for fault in faults:
        print(fault)
    sys.exit(1 if faults or len(graph) < 10 else 0)


main()
