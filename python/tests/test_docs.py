# SPDX-License-Identifier: GPL-3.0-or-later
"""The manual's code runs as it stands, from the top to the bottom, beside the examples."""

import re
import runpy
import textwrap

import pytest

from conftest import REPOSITORY


def blocks(page):
    text = (REPOSITORY / page).read_text(encoding="utf-8")
    return [(text[:found.start()].count("\n") + 2, textwrap.dedent(found.group(1)))
            for found in re.finditer(r"^```python\n(.*?)^```", text, re.DOTALL | re.MULTILINE)]


@pytest.mark.parametrize("page, count", [("docs/python.md", 21), ("README.md", 1)])
def test_code_of_pages_runs(page, count, monkeypatch, capsys, tmp_path):
    pytest.importorskip("matplotlib").use("Agg")
    (tmp_path / "examples").symlink_to(REPOSITORY / "examples")
    monkeypatch.chdir(tmp_path)
    found = blocks(page)
    assert len(found) >= count
    names = {}
    for line, code in found:
        exec(compile("\n" * (line - 1) + code, page, "exec"), names)
    assert capsys.readouterr().out


@pytest.mark.parametrize("script", sorted((REPOSITORY / "python" / "examples").glob("*.py")),
                         ids=lambda path: path.name)
def test_examples_run(script, monkeypatch, tmp_path):
    pytest.importorskip("matplotlib").use("Agg")
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(script), run_name="__main__")
    assert list(tmp_path.glob("*.png"))
