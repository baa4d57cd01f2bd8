#!/usr/bin/env python3
"""Finds paths and names in the documents that the repository does not have. Argument: the repository's root."""
import pathlib
import re
import sys

FOLDERS = {"engine", "game", "haptics", "content", "tools", "tests", "shaders", "docs"}
# Parts of names, and files that programs write.
NOT_IN_SOURCES = {"put_", "add_", "summary.json"}


def files_of(root):
    return [path for folder in sorted(FOLDERS) for path in (root / folder).rglob("*") if path.is_file() and "node_modules" not in path.parts]


def exists(root, path):
    path = path.rstrip("/")
    return any(root.glob(path)) or any((root / (path + ending)).exists() for ending in (".hpp", ".cpp"))


def quoted(document):
    """Yields line number and text of each code span outside of code blocks."""
    in_block = False
    for number, line in enumerate(document.read_text().splitlines(), 1):
        if line.startswith("```"):
            in_block = not in_block
        elif not in_block:
            for text in re.findall(r"`([^`]+)`", line):
                yield number, text


def is_path(text):
    return "node_modules" not in text and " " not in text and "/" in text and text.split("/")[0] in FOLDERS


def check_names(root, document):
    """Finds names of code in a document that stand nowhere in the sources."""
    files, words = set(), set()
    for source in files_of(root):
        files.add(source.name)
        if source.suffix in {".cpp", ".hpp", ".c", ".h", ".json", ".txt", ".glsl", ".vert", ".frag", ".sh", ".py"}:
            words.update(re.findall(r"\w+", source.read_text(errors="replace")))
    for number, text in quoted(document):
        if is_path(text):
            continue
        is_file = re.fullmatch(r"\w+\.(cpp|hpp|glsl|json)", text)
        names = [text] if is_file else re.findall(r"[A-Za-z_]\w+", text)
        for name in names:
            if name not in (files if is_file else words) and name not in NOT_IN_SOURCES:
                yield f"{document.relative_to(root)}:{number}: `{name}` is not in the sources; expected a name that is"


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    documents = sorted(root.glob("*.md")) + [path for path in files_of(root) if path.suffix == ".md"]
    faults = [
        f"{document.relative_to(root)}:{number}: `{text}` does not exist; expected a file or a folder"
        for document in documents
        for number, text in quoted(document) if is_path(text) and not exists(root, text)
    ]
    faults += check_names(root, root / "docs/changes.md")
    print("\n".join(faults), end="\n" if faults else "")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
