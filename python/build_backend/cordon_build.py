# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the package `cordon`: a backend of pip's (PEP 517), and a program for checkouts.

    pip install ./python
    python3 python/build_backend/cordon_build.py --package build/python/package

CMake builds in build/python-cp311 (the version of Python), or in build/release where that is
configured for this Python.
CORDON_BUILD_DIR names another folder, CORDON_BUILD_JOBS how many compilers run at once.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path
from typing import Any, Dict, List, NoReturn, Optional

sys.path.insert(0, str(Path(__file__).resolve().parent))

import cordon_wheel  # noqa: E402

PYTHON = Path(__file__).resolve().parents[1]
ROOT = PYTHON.parent
ADVICE = "scripts/install-dependencies --python installs it on Debian"
#: What CMake says of what is missing, and what it is.
MISSING = {
    r"by \"pybind11\"|module pybind11": "pybind11 (Debian's pybind11-dev) is missing",
    r"Could NOT find Python3": "the headers of Python (Debian's python3-dev) are missing",
    r"No CMAKE_CXX_COMPILER|CMAKE_CXX_COMPILER-NOTFOUND": "a compiler for C++ is missing",
    r"CMAKE_MAKE_PROGRAM is not set": "ninja and make are missing",
}


def build_wheel(wheel_directory: str, config_settings: Optional[Dict[str, Any]] = None,
                metadata_directory: Optional[str] = None) -> str:
    build = built()
    with tempfile.TemporaryDirectory(dir=build) as stage:
        install(build, Path(stage))
        return cordon_wheel.write(Path(stage), Path(wheel_directory), PYTHON, version())


def build_sdist(sdist_directory: str, config_settings: Optional[Dict[str, Any]] = None) -> str:
    fail("there is no source distribution of the package alone: it is built from a checkout of "
         "the whole repository, by pip install ./python")


def prepare_metadata_for_build_wheel(metadata_directory: str,
                                     config_settings: Optional[Dict[str, Any]] = None) -> str:
    return cordon_wheel.write_metadata(Path(metadata_directory), PYTHON, version())


def fail(message: str) -> NoReturn:
    raise SystemExit(f"cordon: {message}")


def version() -> str:
    found = re.search(r"project\(cordon VERSION ([0-9.]+)",
                      (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
                      if (ROOT / "CMakeLists.txt").is_file() else "")
    if not found:
        fail(f"{ROOT} is no checkout of the repository, which the package is built from")
    return found.group(1)


def interpreter() -> str:
    """Not the one of a virtual environment, which may be gone at the next build."""
    return getattr(sys, "_base_executable", None) or sys.executable


def build_directory() -> Path:
    """build/release where it builds the package for this interpreter."""
    if os.environ.get("CORDON_BUILD_DIR"):
        return Path(os.environ["CORDON_BUILD_DIR"]).absolute()
    release = ROOT / "build/release"
    cache = release / "CMakeCache.txt"
    text = cache.read_text(encoding="utf-8", errors="replace") if cache.is_file() else ""
    wanted = ("CORDON_BUILD_PYTHON:BOOL=ON", "CMAKE_BUILD_TYPE:STRING=Release",
              "CORDON_SANITIZE:STRING=",
              f"PYTHON_MODULE_EXTENSION:INTERNAL={sysconfig.get_config_var('EXT_SUFFIX')}",
              f"CMAKE_HOME_DIRECTORY:INTERNAL={ROOT}")
    if all(f"\n{line}\n" in text for line in wanted):
        return release
    return ROOT / f"build/python-{cordon_wheel.tag().split('-')[0]}"


def built() -> Path:
    """Configures and builds; the folder."""
    version()
    if not shutil.which("cmake"):
        fail(f"CMake is missing; {ADVICE}")
    compiler = os.environ.get("CXX", "c++").split()
    if not compiler or not shutil.which(compiler[0]):
        fail(f"a compiler for C++ is missing ({' '.join(compiler)}); {ADVICE}")
    build = build_directory()
    cache = build / "CMakeCache.txt"
    home = f"CMAKE_HOME_DIRECTORY:INTERNAL={ROOT}\n"
    if cache.is_file() and home not in cache.read_text(encoding="utf-8", errors="replace"):
        if os.environ.get("CORDON_BUILD_DIR"):
            fail(f"{build} is a build of something else than {ROOT}")
        shutil.rmtree(build)  # of this checkout, which lay elsewhere
    build.mkdir(parents=True, exist_ok=True)
    configure = ["cmake", "-S", str(ROOT), "-B", str(build)]
    if not cache.is_file():
        configure += ["-G", "Ninja"] if shutil.which("ninja") else []
        configure += ["-DCMAKE_BUILD_TYPE=Release", "-DCORDON_BUILD_TESTS=OFF",
                      "-DCORDON_BUILD_BENCH=OFF", "-DCORDON_BUILD_PYTHON=ON"]
    if build != ROOT / "build/release":
        configure += [f"-DPython3_EXECUTABLE={interpreter()}"]
    jobs = os.environ.get("CORDON_BUILD_JOBS") or str(os.cpu_count() or 1)
    log = build / "python_build.log"
    print(f"Building the package; the log is {log}", file=sys.stderr, flush=True)
    with log.open("wb") as out:
        run(configure, out, log)
        run(["cmake", "--build", str(build), "--target", "python_package", "--parallel", jobs],
            out, log)
    return build


def run(command: List[str], out: Any, log: Path) -> None:
    # Objects of one checkout serve another one of the same machine.
    environment = {"CCACHE_BASEDIR": str(ROOT), "CCACHE_NOHASHDIR": "true", **os.environ}
    out.flush()
    start = out.tell()
    if subprocess.run(command, stdout=out, stderr=subprocess.STDOUT, env=environment).returncode:
        text = log.read_bytes()[start:].decode(errors="replace")
        for pattern, what in MISSING.items():
            if "--build" not in command and re.search(pattern, text):
                fail(f"{what}; {ADVICE}. The log is {log}")
        lines = text.splitlines()
        errors = [line for line in lines if re.search(r"\berror\b", line, re.IGNORECASE)]
        print("\n".join((errors or lines)[:20] + lines[-20:]), file=sys.stderr)
        fail(f"{' '.join(command[:2])} failed; the whole log is {log}")


def install(build: Path, stage: Path) -> None:
    """The package with its libraries below `stage`, each library once, under the name by which it
    is loaded."""
    command = ["cmake", "--install", str(build), "--component", "python", "--strip", "--prefix",
               str(stage)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        fail(f"cmake --install failed: {done.stderr.strip()}")
    links = [path for path in sorted(stage.rglob("*")) if path.is_symlink()]
    targets = {link: link.resolve() for link in links}
    for link, target in targets.items():
        link.unlink()
        shutil.copy2(target, link)
    for target in set(targets.values()):
        target.unlink()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--package", type=Path, metavar="FOLDER", required=True,
                        help="where the package goes, for PYTHONPATH; it is replaced")
    package = parser.parse_args().package.absolute()
    build = built()
    package.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=package.parent) as stage:
        made = Path(stage) / "package"
        install(build, made)
        if package.exists():
            if not (package / "cordon/__init__.py").is_file() and any(package.iterdir()):
                fail(f"{package} is there, and holds something else than the package")
            shutil.rmtree(package)
        made.rename(package)


if __name__ == "__main__":
    main()
