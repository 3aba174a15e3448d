"""Every link of the documentation leads somewhere, and its cases and Python run as written."""

import re
from pathlib import Path

import pytest

import galerna
from galerna.case import parse

ROOT = Path(__file__).parents[1]
PAGES = sorted([ROOT / "README.md", *(ROOT / "docs").rglob("*.md")])
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")


@pytest.mark.parametrize("page", PAGES, ids=lambda p: str(p.relative_to(ROOT)))
def test_links_lead_to_files(page):
    targets = [t for t in LINK.findall(page.read_text()) if "://" not in t]
    missing = [target for target in targets if not (page.parent / target).exists()]
    assert not missing


def test_the_example_of_the_readme_runs(capsys):
    (code,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.S)
    exec(compile(code, "README.md", "exec"), {})
    assert "MW" in capsys.readouterr().out


MACHINE = (ROOT / "docs" / "machine.md").read_text()
CASES = [text for text in re.findall(r"```yaml\n(.*?)```", MACHINE, re.S) if "galerna: 1" in text]


@pytest.mark.parametrize("text", CASES, ids=[re.findall(r"name: (\w+)", t)[0] for t in CASES])
def test_the_cases_of_the_machine_page_run(text):
    simulation = galerna.build_machine(parse(text)).simulation
    simulation.advance()
    assert simulation.record()["rotor_power"] > 0.0


def test_the_example_of_the_machine_page_runs(capsys):
    (code,) = re.findall(r"```python\n(.*?)```", MACHINE, re.S)
    exec(compile(code, "machine.md", "exec"), {})
    out_of_plane, _ = capsys.readouterr().out.split()
    assert 4.0 < float(out_of_plane) < 14.0
