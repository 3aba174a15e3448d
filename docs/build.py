"""Make everything that is generated here: ``python -m docs.build [PART ...]``.

Parts: conventions, case, channels, turbines, vortex_sections, vortex_wings, vortex_rotors, machine,
mooring, afloat, demo, validation, benchmarks; all where none is given.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from docs import (
    case_reference,
    channel_page,
    conventions_figure,
    flexible_rotor_figures,
    machine_figures,
    mooring_figure,
    turbine_pages,
    vortex_rotor_figures,
    vortex_section_pages,
    vortex_wing_figures,
)

HERE = Path(__file__).parent
ROOT = HERE.parent


def demo() -> Path:
    """Run the demonstration and keep its pictures."""
    with tempfile.TemporaryDirectory() as folder:
        galerna("demo", cwd=Path(folder))
        pictures = sorted(Path(folder).rglob("*.png"))
        for picture in pictures:
            shutil.copy(picture, HERE / "figures" / f"demo_{picture.name}")
    return HERE / "figures"


def validation() -> Path:
    """Run every validation case; a failed check stays on the page and does not stop it."""
    page = HERE / "validation.md"
    galerna("validate", "--page", str(page), check=False)
    return page


def benchmarks() -> Path:
    """Run every benchmark; a missed figure stays on the page and does not stop it."""
    page = HERE / "benchmarks.md"
    subprocess.run([sys.executable, "-m", "benchmarks", "--page", str(page)], cwd=ROOT, check=False)
    return page


def galerna(*arguments: str, cwd: Path = ROOT, check: bool = True) -> None:
    """Run the command line of this environment."""
    subprocess.run([sys.executable, "-m", "galerna.cli", *arguments], cwd=cwd, check=check)


PARTS: dict[str, Callable[[], Path]] = {
    "conventions": conventions_figure.draw,
    "case": case_reference.write,
    "channels": channel_page.write,
    "turbines": turbine_pages.write,
    "vortex_sections": vortex_section_pages.write,
    "vortex_wings": vortex_wing_figures.draw,
    "vortex_rotors": vortex_rotor_figures.draw,
    "flexible_rotor": flexible_rotor_figures.draw,
    "machine": machine_figures.draw,
    "mooring": mooring_figure.draw,
    "demo": demo,
    "validation": validation,
    "benchmarks": benchmarks,
}


def main(names: list[str]) -> int:
    unknown = [name for name in names if name not in PARTS]
    if unknown:
        print(f"no part {unknown[0]!r}; parts: {', '.join(PARTS)}", file=sys.stderr)
        return 2
    for name in names or PARTS:
        print(f"{name}: {PARTS[name]()}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
