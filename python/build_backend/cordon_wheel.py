# SPDX-License-Identifier: GPL-3.0-or-later
"""A folder as a wheel, the same byte for byte whenever it is written."""

from __future__ import annotations

import base64
import hashlib
import sys
import sysconfig
import tomllib
import zipfile
from pathlib import Path
from typing import Any, Dict, List


def tag() -> str:
    """cp311-cp311-linux_x86_64"""
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    abi = python + getattr(sys, "abiflags", "")
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    return f"{python}-{abi}-{platform}"


def _project(source: Path) -> Dict[str, Any]:
    found: Dict[str, Any] = tomllib.loads(
        (source / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return found


def _metadata(source: Path, version: str) -> Dict[str, bytes]:
    """Files of the folder .dist-info beside RECORD."""
    project = _project(source)
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version}",
             f"Summary: {project['description']}", f"License: {project['license']['text']}",
             f"Requires-Python: {project['requires-python']}"]
    lines += [f"Requires-Dist: {name}" for name in project["dependencies"]]
    for extra, names in sorted(project["optional-dependencies"].items()):
        lines.append(f"Provides-Extra: {extra}")
        lines += [f"Requires-Dist: {name} ; extra == '{extra}'" for name in names]
    wheel = ["Wheel-Version: 1.0", "Generator: cordon", "Root-Is-Purelib: false", f"Tag: {tag()}"]
    files = {"METADATA": "\n".join(lines) + "\n", "WHEEL": "\n".join(wheel) + "\n"}
    made = {name: text.encode() for name, text in files.items()}
    made["LICENSE"] = (source.parent / "LICENSE").read_bytes()
    return made


def _folder(source: Path, version: str) -> str:
    return f"{_project(source)['name']}-{version}.dist-info"


def write_metadata(directory: Path, source: Path, version: str) -> str:
    folder = _folder(source, version)
    (directory / folder).mkdir(parents=True, exist_ok=True)
    for name, content in _metadata(source, version).items():
        (directory / folder / name).write_bytes(content)
    return folder


def write(stage: Path, directory: Path, source: Path, version: str) -> str:
    """The files below `stage` as a wheel in `directory`; its name."""
    folder = _folder(source, version)
    name = f"{folder.removesuffix('.dist-info')}-{tag()}.whl"
    found = [path for path in stage.rglob("*")
             if path.is_file() and "__pycache__" not in path.parts]
    files = {path.relative_to(stage).as_posix(): path.read_bytes() for path in found}
    files = dict(sorted(files.items()))
    files.update({f"{folder}/{key}": value for key, value in _metadata(source, version).items()})
    record: List[str] = []
    for path, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record.append(f"{path},sha256={digest},{len(content)}")
    record.append(f"{folder}/RECORD,,")
    files[f"{folder}/RECORD"] = ("\n".join(record) + "\n").encode()
    directory.mkdir(parents=True, exist_ok=True)
    partial = directory / f"{name}.partial"
    with zipfile.ZipFile(partial, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for path, content in files.items():
            entry = zipfile.ZipInfo(path, (1980, 1, 1, 0, 0, 0))
            entry.create_system = 3
            entry.external_attr = (0o100755 if ".so" in Path(path).name else 0o100644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, content)
    partial.replace(directory / name)
    return name
