"""The command line: every command is a few lines around the API."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from galerna import __version__
from galerna.errors import GalernaError, InputError

app = typer.Typer(
    name="galerna",
    help="Wind turbines simulated as one machine: wind, rotor, structure, sea and control.",
    epilog="Start with: galerna demo",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    context_settings={"help_option_names": ["-h", "--help"]},
)

CaseArgument = Annotated[
    str, typer.Argument(metavar="CASE", help="A case file (.yaml), or a built-in case by name.")
]
TurbineArgument = Annotated[
    str,
    typer.Argument(metavar="TURBINE", help="A built-in turbine, a windIO file, or a .fst deck."),
]
ResultArgument = Annotated[
    Path, typer.Argument(metavar="RESULT", help="A result (.nc), finished or half-written.")
]
EveryOption = Annotated[
    float, typer.Option("--checkpoint-every", min=0.0, help="Wall-clock s between checkpoints.")
]
KeepOption = Annotated[
    bool, typer.Option("--keep-checkpoint", help="Keep the last one of a complete run, to go on.")
]


def example(*lines: str) -> str:
    """The example under a command's help."""
    return "[bold]Example:[/bold]  " + "   ".join(lines)


@app.command(epilog=example("galerna run demo --duration 60 --output here.nc"))
def run(
    case: CaseArgument,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Result file; CASE.nc by default.")
    ] = None,
    duration: Annotated[
        float | None, typer.Option(help="Simulated time in s instead of the case's.")
    ] = None,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Replace the result if there is one.")
    ] = False,
    checkpoint_every: EveryOption = 60.0,
    keep_checkpoint: KeepOption = False,
) -> None:
    """Simulate a case into a result file."""
    from galerna import commands
    from galerna.saving import Saving

    saving = Saving(checkpoint_every, keep_checkpoint)
    commands.run(case, output, duration, overwrite, saving)


@app.command(epilog=example("galerna resume my_case.nc"))
def resume(
    result: ResultArgument,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Another result file for all of it.")
    ] = None,
    duration: Annotated[
        float | None, typer.Option(help="Simulated time in s, from 0, instead of the case's.")
    ] = None,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Replace what stands at --output.")
    ] = False,
    checkpoint_every: EveryOption = 60.0,
    keep_checkpoint: KeepOption = False,
) -> None:
    """Go on with a run that was stopped or killed, to the bits of one that was not."""
    from galerna import commands
    from galerna.saving import Saving

    saving = Saving(checkpoint_every, keep_checkpoint)
    commands.resume(result, output, duration, overwrite, saving)


@app.command(epilog=example("galerna check my_case.yaml"))
def check(case: CaseArgument) -> None:
    """Check a case: the file, the turbine, the wind, the box; everything but the run."""
    from galerna import commands

    commands.check(case)


@app.command(epilog=example("galerna channels controlled 'blade_root_*'"))
def channels(
    case: CaseArgument,
    pattern: Annotated[
        str | None,
        typer.Argument(help="A name or pattern with * and ?, of galerna or of OpenFAST."),
    ] = None,
) -> None:
    """List the channels of a case's result, with OpenFAST's names."""
    from galerna import commands

    commands.list_channels(case, pattern)


@app.command(epilog=example("galerna demo"))
def demo(
    folder: Annotated[
        Path, typer.Option(help="Where the result and the pictures go; replaced if there.")
    ] = Path("galerna_demo"),
    duration: Annotated[float | None, typer.Option(help="Simulated time in s.")] = None,
) -> None:
    """Run the NREL 5 MW rotor in turbulent wind and draw what came out."""
    from galerna import commands

    commands.demo(folder, duration)


@app.command(epilog=example("galerna examples --copy my_examples"))
def examples(
    copy: Annotated[
        Path | None, typer.Option(help="Copy the built-in cases and scripts to this folder.")
    ] = None,
) -> None:
    """List the built-in cases, or copy them."""
    from galerna import commands

    commands.list_examples(copy)


@app.command(epilog=example("galerna turbines"))
def turbines() -> None:
    """List the built-in turbines."""
    from galerna import commands

    commands.list_turbines()


@app.command(epilog=example("galerna turbine nrel5mw"))
def turbine(name: TurbineArgument) -> None:
    """Show a turbine's figures beside the published ones."""
    from galerna import commands

    commands.show_turbine(name)


@app.command(epilog=example("galerna power-curve dtu10mw --plot curve.png --csv curve.csv"))
def power_curve(
    turbine: TurbineArgument,
    plot: Annotated[Path | None, typer.Option(help="Draw the curve into this PNG.")] = None,
    csv: Annotated[Path | None, typer.Option(help="Write the curve into this file.")] = None,
    step: Annotated[float, typer.Option(min=0.01, help="Between wind speeds, m/s.")] = 1.0,
    flexible: Annotated[
        bool, typer.Option("--flexible", help="Let the blades bend and twist.")
    ] = False,
) -> None:
    """Compute the steady power and thrust over the wind speed."""
    from galerna import commands

    commands.power_curve(turbine, plot, csv, step, flexible)


@app.command(epilog=example("galerna tune nrel5mw --flexible --output gains.yaml"))
def tune(
    turbine: TurbineArgument,
    frequency: Annotated[
        float | None,
        typer.Option(help="Natural frequency, rad/s; 0.6, or 0.2 for a turbine that floats."),
    ] = None,
    damping: Annotated[float, typer.Option(help="Damping ratio.")] = 0.7,
    constant_torque: Annotated[
        bool, typer.Option("--constant-torque", help="Torque, not power, is held above rated.")
    ] = False,
    flexible: Annotated[
        bool, typer.Option("--flexible", help="Let the blades bend and twist.")
    ] = False,
    floating: Annotated[
        bool | None,
        typer.Option("--floating/--fixed", help="By default, as the turbine has a platform."),
    ] = None,
    following_wake: Annotated[
        bool, typer.Option("--following-wake", help="Let the wake follow the pitch at once.")
    ] = False,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Store the gains in this YAML file.")
    ] = None,
) -> None:
    """Compute the gains of the pitch controller from the rotor's sensitivity to pitch."""
    from galerna import commands
    from galerna.coupling.tune import TuneSettings

    settings = TuneSettings(frequency, damping, constant_torque, flexible, floating, following_wake)
    commands.tune(turbine, settings, output)


@app.command(epilog=example("galerna wind turbulent --bts box.bts --plot wind.png"))
def wind(
    case: CaseArgument,
    bts: Annotated[Path | None, typer.Option(help="Write the box as a TurbSim file.")] = None,
    hawc2: Annotated[
        Path | None,
        typer.Option(help="Write the box for HAWC2, as this name with _u.bin, _v.bin, _w.bin."),
    ] = None,
    plot: Annotated[Path | None, typer.Option(help="Draw slices into this PNG.")] = None,
) -> None:
    """Make the wind of a case: describe it, write it, draw it."""
    from galerna import commands

    commands.wind(case, bts, hawc2, plot)


@app.command(epilog=example("galerna hydro nrel5mw_oc3 --panel-size 1.5"))
def hydro(
    turbine: TurbineArgument,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="File; TURBINE.hydro.nc by default.")
    ] = None,
    panel_size: Annotated[float, typer.Option(help="Largest side of a panel, m.")] = 2.0,
    sectors: Annotated[int, typer.Option(help="Panels around a body of revolution.")] = 96,
    last_frequency: Annotated[float, typer.Option(help="Highest frequency, rad/s.")] = 5.0,
    heading_step_deg: Annotated[float, typer.Option(help="Between two headings, deg.")] = 10.0,
    water_depth: Annotated[float | None, typer.Option(help="m; the turbine's by default.")] = None,
) -> None:
    """Compute a platform's potential-flow coefficients from its hull (extra: hydro)."""
    from galerna import commands

    commands.hydro(
        turbine,
        output,
        last_frequency=last_frequency,
        heading_step_deg=heading_step_deg,
        panel_size=panel_size,
        sectors=sectors,
        water_depth=water_depth,
    )


@app.command(epilog=example("galerna validate rotor --json checks.json"))
def validate(
    names: Annotated[
        list[str] | None, typer.Argument(metavar="[GROUP|CASE]...", help="Default: all.")
    ] = None,
    list_only: Annotated[bool, typer.Option("--list", help="List the cases only.")] = False,
    json: Annotated[Path | None, typer.Option(help="Write every check to this file.")] = None,
    page: Annotated[Path | None, typer.Option(help="Write the page of the documentation.")] = None,
) -> None:
    """Hold galerna against published and analytical results."""
    from galerna import commands

    raise typer.Exit(commands.validate(names or [], list_only, json, page))


@app.command(epilog=example("galerna plot demo.nc", "galerna plot demo.nc -c rotor_thrust"))
def plot(
    result: ResultArgument,
    channel: Annotated[
        list[str] | None, typer.Option("--channel", "-c", help="Only this channel; repeatable.")
    ] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder; RESULT_plots by default.")
    ] = None,
) -> None:
    """Draw a result: rotor over time, along the span, spectra, inflow."""
    from galerna import commands

    commands.plot(result, channel or [], output)


@app.command(epilog=example("galerna export demo.nc demo.outb"))
def export(
    result: ResultArgument,
    file: Annotated[Path, typer.Argument(help="A file .outb (OpenFAST's binary) or .csv.")],
) -> None:
    """Write a result for other tools."""
    from galerna import commands

    commands.export(result, file)


@app.command(epilog=example("galerna cite turbulent --bibtex > used.bib"))
def cite(
    case: CaseArgument,
    bibtex: Annotated[bool, typer.Option("--bibtex", help="As BibTeX entries.")] = False,
) -> None:
    """List the publications behind the models and the turbine of a case."""
    from galerna import commands

    commands.cite(case, bibtex)


@app.command(hidden=True, epilog=example("galerna schema > case.schema.json"))
def schema() -> None:
    """Print the JSON schema of case files, for editors."""
    from galerna import commands

    commands.schema()


def _version(wanted: bool) -> None:
    if wanted:
        print(f"galerna {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None: ...


def main(arguments: list[str] | None = None) -> Any:
    """Run the command line; exits with 0 done, 1 a check failed, 2 bad input, 3 no convergence."""
    try:
        app(args=arguments)
    except GalernaError as error:
        _report(error)
        sys.exit(error.exit_code)
    except OSError as error:
        _report(InputError(str(error.filename or "file"), error.strerror or str(error)))
        sys.exit(InputError.exit_code)


def _report(error: GalernaError) -> None:
    """An error on stderr without a traceback, with the notes on it."""
    from rich.console import Console
    from rich.markup import escape

    console = Console(stderr=True, highlight=False, soft_wrap=True)
    console.print(f"[bold red]error[/] {escape(str(error))}")
    for note in getattr(error, "__notes__", ()):
        console.print(escape(note))


if __name__ == "__main__":
    main()
