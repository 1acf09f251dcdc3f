"""The command line. Numbers for machines go to stdout with --json, tables and progress to the terminal."""

import gc
import io
import json
import os
import re
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from functools import partial
from glob import escape as glob_escape
from glob import glob
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pitchpoint.errors import InputError, PitchpointError, shorten, visible

if TYPE_CHECKING:
    from pitchpoint.cases.study_tables import Study, Sweep
    from pitchpoint.results.target_rows import TargetRow
    from pitchpoint.runs.case import Case
    from pitchpoint.runs.run import Outcome, Progress
    from pitchpoint.views.section import Printed

app = typer.Typer(
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

_INTERRUPTED = 130

_LONGEST = 2000  # characters of one complaint
_SWEEP = re.compile(r"([^=]{0,500})=([^:]*):([^:]*):\s*([1-9][0-9]{0,4}|100000)\s*", re.ASCII)


def _cases_from(incomplete: str) -> list[str]:
    """Shipped cases, TOML files and manifests that begin so, for the completion of a shell."""
    from pitchpoint.cases.library import case_names

    shipped = [name for name in case_names() if name.startswith(incomplete)]
    found = sorted(glob(f"{glob_escape(incomplete)}*"))
    files = [path for path in found if path.endswith((".toml", "manifest.json"))]
    return [*shipped, *files, *(f"{path}/" for path in found if Path(path).is_dir())]


def _variants_from(context: typer.Context, incomplete: str) -> list[str]:
    """Variants of the case that stands before on the line."""
    from pitchpoint.cases.document import variants
    from pitchpoint.cases.library import find_case

    try:
        known = variants(find_case(next(iter(context.args), ""))[1])
    except PitchpointError:
        return []
    return [name for name in known if name.startswith(incomplete)]


def _keys_from(incomplete: str) -> list[str]:
    """Keys of case files that begin so."""
    from pitchpoint.cases.keys import keys

    return [f"{key}=" for key in keys() if key.startswith(incomplete)]


def _kinds_from(incomplete: str) -> list[str]:
    """Kinds of quantities whose unit can be chosen that begin so."""
    from pitchpoint.results.chosen_units import choosable

    return [f"{kind}=" for kind in choosable() if kind.startswith(incomplete)]


CaseName = Annotated[
    str,
    typer.Argument(
        metavar="CASE",
        help="A shipped case, a TOML file, or a folder that `run` wrote, which is run again.",
        autocompletion=_cases_from,
    ),
]
Designs = Annotated[
    list[str],
    typer.Argument(
        metavar="CASE...",
        help="Cases, files, folders that `run` wrote, or one variant of them, case@variant.",
        autocompletion=_cases_from,
    ),
]
Result = Annotated[str, typer.Argument(metavar="RESULT", help="Folder that `run` wrote.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON to stdout instead of tables.")]
Variants = Annotated[
    list[str] | None,
    typer.Option(
        "--variant", help="Run this variant only; may be repeated.", autocompletion=_variants_from
    ),
]
OneVariant = Annotated[
    str | None,
    typer.Option("--variant", help="The first one by default.", autocompletion=_variants_from),
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help='For example operation.torque="200 N m".',
        autocompletion=_keys_from,
    ),
]
Sweeps = Annotated[
    list[str] | None,
    typer.Option(
        "--sweep",
        metavar="KEY=START:STOP:COUNT",
        help='For example operation.speed="500 rpm:3000 rpm:11".',
        autocompletion=_keys_from,
    ),
]
UnitsByKind = Annotated[
    list[str] | None,
    typer.Option(
        "--units",
        metavar="KIND=UNIT",
        help='Units to show, for example "angle=arcmin, torsional stiffness=N m/arcmin".',
        autocompletion=_kinds_from,
    ),
]
Folder = Annotated[
    Path | None,
    typer.Option("-o", "--output", metavar="DIR", help="Default: results/CASE."),
]
Overwrite = Annotated[
    bool, typer.Option("--overwrite", help="Replace the results of another case in the folder.")
]


_garbage_waits = False


def command() -> None:
    """Entry point of a process of its own, which looks for no garbage among what it imports.

    To go through all of it again and again as it grows took a sixth of a later run.
    """
    global _garbage_waits
    _garbage_waits = True
    gc.disable()
    main()


def _look_for_garbage() -> None:
    """From now on, and only among what is new; nothing is changed where `main` is called by others."""
    global _garbage_waits
    if _garbage_waits:
        _garbage_waits = False
        gc.freeze()
        gc.enable()


def main() -> None:
    """Run a command: one sentence for what went wrong, and the exit status that goes with it."""
    os.environ["JAX_ENABLE_X64"] = "1"  # a process of its own, where no function needs the scope
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # a terminal need not know every letter of a title
            stream.reconfigure(errors="backslashreplace")
    try:
        status = app(standalone_mode=False) or 0
    except PitchpointError as error:
        for one in error.every:
            _complain(f"error: {one}")
        status = error.exit_code
    except typer.TyperException as error:
        told = error.format_message().rstrip(".")
        if told:  # without arguments the help is all there is to say
            context = getattr(error, "ctx", None)
            of = "pitchpoint" if context is None else context.command_path
            _complain(f"error: {shorten(told, 200)}; see {of} --help{_advice(told, of)}")
        status = error.exit_code
    except BrokenPipeError:
        sys.stderr.close()
        status = 1
    except OSError as error:
        _complain(f"error: {error.filename or 'a file'}: {error.strerror}")
        status = 1
    if status == _INTERRUPTED:
        _complain("interrupted")
    raise SystemExit(status)


_OTHER_COMMANDS = {
    "report": "run writes report.html into its folder, and pitchpoint open FOLDER opens it",
    "plot": "run writes report.html with its figures, and pitchpoint open FOLDER opens it",
    **dict.fromkeys(
        ("validate", "verify", "lint"), "pitchpoint check CASE tells what is wrong with it"
    ),
    **dict.fromkeys(("solve", "compute", "calc", "calculate"), "pitchpoint run CASE computes it"),
    **dict.fromkeys(("list", "ls"), "pitchpoint cases lists the shipped ones"),
    **dict.fromkeys(("init", "create", "template"), "pitchpoint new FAMILY writes a case file"),
    "help": "pitchpoint docs has the pages",
    "sweep": 'it is an option: pitchpoint run CASE --sweep operation.speed="500 rpm:3000 rpm:11"',
}
"""Commands as other programs have them, with what to call."""

_TAKES = {
    "models": "one kind or name, such as friction",
    "cases": "nothing and lists all; pitchpoint show CASE has the inputs of one",
    "new": "one family; keys follow in the file",
}
"""What commands take that are called with more words than that."""

_OPTIONS = {
    "--set": '--set operation.torque="50 N m"',
    "--over": '--over operation.torque="20 N m:90 N m:8"',
    "--sweep": '--sweep operation.speed="500 rpm:3000 rpm:11"',
    "--units": "--units angle=arcmin",
    "--vary": '--vary gears.face_width="10 mm:30 mm"',
    "--subject": '--subject "root_safety >= 1.5"',
}
"""Options whose values have a form, with one."""


def _advice(told: str, of: str) -> str:
    """End of a sentence on a command line that is none: what to call in its place.

    Args:
        told: what is wrong with it.
        of: command that was called, with the program.
    """
    name = ([*told.split("'"), ""])[1] if "'" in told else ""
    if told.startswith("No such command") and name in _OTHER_COMMANDS:
        return f"; {_OTHER_COMMANDS[name]}"
    if "requires an argument" in told and name in _OPTIONS:
        return f"; write {_OPTIONS[name]}"
    if told.startswith("No such option") and of == "pitchpoint":
        return "; options stand behind the command: pitchpoint run CASE -o FOLDER"
    if told.startswith("Got unexpected extra") and of.split()[-1] in (
        "run",
        "check",
        "show",
        "explore",
    ):
        return "; it takes one case, pitchpoint compare several"
    if told.startswith("Got unexpected extra") and of.split()[-1] in _TAKES:
        return f"; it takes {_TAKES[of.split()[-1]]}"
    if told.startswith("Missing argument 'CASE"):
        return (
            "; a case is a TOML file (pitchpoint new writes one) or a name out of pitchpoint cases"
        )
    return ""


def _tell_version(asked: bool) -> None:
    if asked:
        from pitchpoint import __version__

        typer.echo(f"pitchpoint {__version__}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool,
        typer.Option("--version", help="Print the version.", callback=_tell_version, is_eager=True),
    ] = False,
) -> None:
    """Load, sliding, film, friction and efficiency where gear teeth touch."""


@app.command()
def cases(json_: AsJson = False) -> None:
    """List the cases that ship with the package."""
    from pitchpoint.cases.library import case_names, find_case

    rows = [
        {"case": name, "title": str(find_case(name)[1].get("title", ""))} for name in case_names()
    ]
    _show(rows, json_, ("case", "title"))


@app.command()
def show(
    case: CaseName, variant: Variants = None, set_: Settings = None, json_: AsJson = False
) -> None:
    """Show the inputs of a case as resolved, and its issues."""
    from pitchpoint.runs.run import uncomputed_manifests

    manifests = uncomputed_manifests(case, only=variant or [], settings=_settings(set_ or []))
    if json_:
        _emit(manifests)
        return
    from pitchpoint.views.inputs import printed_input_rows

    for number, manifest in enumerate(manifests):
        _heading(manifest, number)
        columns = ("table", "key", "value", "status", "where", "note")
        _table(printed_input_rows(manifest), columns)
        _warn(manifest["warnings"])
    for issue in manifests[0]["issues"]:
        _console().print(f"- {_plain(issue['where'])}: {_plain(issue['issue'])}. ", end="")
        _console().print(_plain(issue["verdict"]), style="dim")


@app.command()
def check(case: CaseName, variant: Variants = None, set_: Settings = None) -> None:
    """Tell what is wrong with a case, its teeth do not bear, or warns, before it is computed."""
    from pitchpoint.core.doubts import ranked_doubts
    from pitchpoint.runs.check import check_case

    told = ranked_doubts(check_case(case, variant or [], _settings(set_ or [])))
    _failing(told["implausible"])
    if not told["implausible"]:
        typer.echo("ok")
    _warn(told["warnings"])


@app.command()
def run(
    case: CaseName,
    output: Folder = None,
    variant: Variants = None,
    set_: Settings = None,
    sweep: Sweeps = None,
    units: UnitsByKind = None,
    overwrite: Overwrite = False,
    full: Annotated[
        bool, typer.Option("--full", help="Print the tables of all sections, not the first screen.")
    ] = False,
    json_: AsJson = False,
) -> None:
    """Compute a case: the answer here, report.html in a folder."""
    from pitchpoint.cases.record import default_folder, folder_record
    from pitchpoint.runs.run import run_case as compute

    settings, studies = _settings(set_ or []), _studies(sweep or [])
    if units:
        settings["output.units"] = _units(units)
    folder = output or default_folder(case, Path("results"), settings)
    before = None if overwrite else folder_record(folder)
    with _progress(folder) as progress:
        outcomes = compute(
            case,
            folder=folder,
            only=variant or [],
            settings=settings,
            studies=studies,
            overwrite=overwrite,
            progress=progress,
        )
        progress.part("", "report", False)
        _write_report(outcomes, folder)
    if before and (words := before.replaced_by(folder_record(folder))):
        typer.echo(visible(f"{folder} held a run {words}; this one has replaced it"), err=True)
    if json_:
        _emit({name: _figures(outcome) for name, outcome in outcomes.items()})
        return
    with _shown_units(outcomes):
        if full:
            _in_full(outcomes)
        _first_screen(outcomes, folder / "report.html", tables=not full)


def _in_full(outcomes: "dict[str, Outcome]") -> None:
    """Tables of all sections, and the verdicts on published numbers by their kind."""
    for number, outcome in enumerate(outcomes.values()):
        _summary(outcome, number)
    measured = {name: outcome.rows for name, outcome in outcomes.items() if outcome.rows}
    for name, rows in measured.items():
        _verdicts(rows, f"{name}, " if len(measured) > 1 else "")
    _console().print()


_STYLES = {"title": "bold", "fails": "bold red", "doubt": "yellow", "figure": "", "note": "dim"}


def _first_screen(outcomes: "dict[str, Outcome]", report: Path, *, tables: bool) -> None:
    """The answer; several variants side by side in a table, and sweeps that were asked for."""
    from pitchpoint.views.first_screen import beside_each_other, first_screen, swept_beside
    from pitchpoint.views.sections.studies import extrapolated_note

    console = _console()
    for line in first_screen(outcomes, report, console.width, tables=tables):
        console.print(_plain_line(line.text), style=_STYLES[line.style], soft_wrap=True)
    if len(outcomes) > 1:
        _table(beside_each_other(outcomes), ("", *outcomes))
    for rows in swept_beside(outcomes) if tables else ():
        _table(rows, tuple(rows[0]))
        if note := extrapolated_note(row.values() for row in rows):
            console.print(note, style="dim")


@app.command()
def explore(
    case: CaseName,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE", help="Default: results/CASE/explorer.html."),
    ] = None,
    variant: OneVariant = None,
    set_: Settings = None,
    over: Annotated[
        list[str] | None,
        typer.Option(
            "--over",
            metavar="KEY=START:STOP:COUNT",
            help="What is on a slider; load, speed and one key of the gears by default.",
            autocompletion=_keys_from,
        ),
    ] = None,
    units: UnitsByKind = None,
) -> None:
    """Write a page with inputs on sliders and teeth that move.

    It opens offline. The page holds figures that were computed beforehand, and interpolates between them.
    """
    from pitchpoint.cases.record import default_folder
    from pitchpoint.results.store import demand_writable_folder, make_folder
    from pitchpoint.runs.explore import explore as compute
    from pitchpoint.views.explorer import Reader, write_explorer

    settings, sweeps = _settings(set_ or []), list(_sweeps(over or [], "--over"))
    if units:
        settings["output.units"] = _units(units)
    path = output or default_folder(case, Path("results"), settings) / "explorer.html"
    if path.suffix.lower() not in (".html", ".htm"):
        raise InputError("is no name of a page; give one that ends in .html", file=str(path))
    demand_writable_folder(path.parent)
    read = Reader()
    with _progress(None) as progress:
        found = compute(
            case, sweeps, read=read, variant=variant, settings=settings, progress=progress
        )
    make_folder(path.parent)
    write_explorer(found, read.drawings, path)
    typer.echo(visible(str(path)))


@app.command()
def study(
    case: CaseName,
    over: Annotated[
        list[str] | None,
        typer.Option(
            "--over",
            metavar="KEY=VALUES",
            help='"operation.torque=20 N m:90 N m:8", a list "gears.teeth.1=[20, 21]"; two ends where drawn.',
            autocompletion=_keys_from,
        ),
    ] = None,
    how: Annotated[
        str | None,
        typer.Option(
            "--how",
            metavar="WAY",
            help="grid, zip, latin_hypercube, sobol, or saltelli, of which Sobol' indices follow.",
        ),
    ] = None,
    n: Annotated[
        int | None, typer.Option("-n", "--designs", metavar="N", help="Designs to draw.")
    ] = None,
    seed: Annotated[
        int | None, typer.Option("--seed", help="The same one draws the same designs.")
    ] = None,
    tolerances: Annotated[
        str | None,
        typer.Option(
            "--tolerances",
            metavar="DISTRIBUTION",
            help="uniform or normal: draws what gears.inspection allows.",
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Default: results/CASE/study."),
    ] = None,
    variant: OneVariant = None,
    set_: Settings = None,
    workers: Annotated[
        int | None,
        typer.Option("--workers", metavar="N", help="Processes of this machine that compute."),
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(
            "--scheduler", metavar="ADDRESS", help="Of dask.distributed: tcp://host:8786."
        ),
    ] = None,
    piece: Annotated[
        int | None, typer.Option("--piece", metavar="N", help="Designs kept together; 4096.")
    ] = None,
    csv: Annotated[
        Path | None,
        typer.Option("--csv", metavar="FILE", help="Write every design as a row too."),
    ] = None,
    units: UnitsByKind = None,
    json_: AsJson = False,
) -> None:
    r"""Compute many designs of a case, from a few to millions, into files.

    Which ones stands in the table \[study] of the case, or in options. What is
    killed goes on from the pieces that are kept, when the same command is
    given again.
    """
    from pitchpoint.cases.record import default_folder
    from pitchpoint.runs.case import Case
    from pitchpoint.runs.study import folder_of_table, table_of_study
    from pitchpoint.runs.study import study as compute
    from pitchpoint.views.many_designs import (
        as_plain,
        figures_of_many,
        indices_of_many,
        write_rows,
    )
    from pitchpoint.views.study_report import demand_study_folder, write_study_folder

    settings = _settings(set_ or [])
    chosen = (Case(case) if variant is None else Case(case, variant=variant)).set(settings)
    of_table = None if over or tolerances else table_of_study(chosen)
    if of_table is None and not (over or tolerances):
        raise InputError(
            "a study needs the values of a key, in a table [study] of the case or by option: "
            f"{_OPTIONS['--over']}"
        )
    usual = default_folder(case, Path("results"), settings) / "study"
    folder = output or folder_of_table(of_table, chosen) or usual
    demand_study_folder(folder, case)
    with _progress(folder, "pieces") as progress:
        in_units = partial(
            compute,
            chosen,
            _values_over(over, chosen) if over else None,
            how,  # type: ignore[arg-type]
            n=n,
            seed=seed,
            tolerances=tolerances,
            folder=folder,
            piece=piece,
            workers=workers,
            scheduler=scheduler,
        )
        shown = in_units(units=_units(units) if units else "shown", progress=progress)
        found = in_units(units="si") if json_ and not units else shown
    write_study_folder(shown, chosen, folder)
    if csv is not None:
        write_rows(found, csv)
    if json_:
        _emit(as_plain(found, folder))
        return
    told, rows = figures_of_many(found, folder)
    _table(rows, tuple(rows[0]))
    about, indices = indices_of_many(found)
    if indices:
        _console().print(_plain_line(about), soft_wrap=True)
        _table(indices, tuple(indices[0]))
    for line in told:
        _console().print(_plain_line(line), soft_wrap=True)


@app.command()
def optimise(
    case: CaseName,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary",
            metavar="KEY=VALUES",
            help='Between two ends, "gears.face_width=10 mm:30 mm", or each of "gears.teeth.1=[20, 21]".',
            autocompletion=_keys_from,
        ),
    ] = None,
    minimise: Annotated[
        str | None, typer.Option(metavar="RESULT", help="As mean_loss, disc_mass.1.")
    ] = None,
    maximise: Annotated[str | None, typer.Option(metavar="RESULT", help="In its place.")] = None,
    subject: Annotated[
        list[str] | None,
        typer.Option(
            "--subject", metavar="LIMIT", help='"root_safety >= 1.5", "centre_distance = 84 mm".'
        ),
    ] = None,
    law: Annotated[
        str | None, typer.Option("--law", metavar="NAME", help="Of friction; the first one.")
    ] = None,
    starts: Annotated[
        int | None,
        typer.Option("--starts", metavar="N", help="Designs to begin with; 16 for each key."),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Default: results/CASE/optimum."),
    ] = None,
    variant: OneVariant = None,
    set_: Settings = None,
    units: UnitsByKind = None,
    overwrite: Overwrite = False,
    json_: AsJson = False,
) -> None:
    r"""Vary numbers of a case until one result is least or largest, and others are within limits.

    What varies, the aim and the limits stand in options, or in the table
    \[optimise] of the case. The best design is written as a case file, and
    every design that was computed as a line of a table.
    """
    from pitchpoint.cases.record import default_folder
    from pitchpoint.results.chosen_units import shown_in
    from pitchpoint.runs.case import Case
    from pitchpoint.runs.optimise import folder_of_optimum, table_of_optimiser
    from pitchpoint.runs.optimise import optimise as search
    from pitchpoint.views.optimum_screen import optimum_as_json, optimum_screen

    settings = _settings(set_ or [])
    chosen = (Case(case) if variant is None else Case(case, variant=variant)).set(settings)
    of_table = None if vary else table_of_optimiser(chosen)
    if of_table is None and not vary:
        raise InputError(
            "an optimiser needs a key to vary, in a table [optimise] of the case or by option: "
            f"{_OPTIONS['--vary']}"
        )
    usual = default_folder(case, Path("results"), settings) / "optimum"
    folder = output or folder_of_optimum(of_table, chosen) or usual
    with _progress(None) as progress:  # what was kept is told with the best so far
        found = search(
            chosen,
            _varied(vary) if vary else None,
            minimise=minimise,
            maximise=maximise,
            subject_to=subject,
            law=law,
            starts=starts,
            folder=folder,
            overwrite=overwrite,
            progress=progress,
        )
    if json_:
        _emit(optimum_as_json(found))
    else:
        console = _console()
        with shown_in(_units(units) if units else {}):
            for line in optimum_screen(found, console.width):
                console.print(_plain_line(line.text), style=_STYLES[line.style], soft_wrap=True)
    if found.interrupted:
        raise SystemExit(_INTERRUPTED)


def _varied(texts: list[str]) -> dict[str, Any]:
    """What varies by key: two ends, or each value of a list."""
    from pitchpoint.input.quantities import shown

    varied: dict[str, Any] = {}
    for text in texts:
        key, equals, given = (part.strip() for part in text.partition("="))
        if not (key and equals and given):
            told = f"{shown(text)} is not KEY=VALUES, such as {_OPTIONS['--vary']}"
            raise InputError(told, key="--vary")
        if key in varied:
            raise InputError(f"{shown(key)} was given twice", key="--vary")
        value = _value(given) if given.startswith("[") else given
        varied[key] = {"values": value} if isinstance(value, list) else given
    return varied


@app.command()
def bench(
    designs: Designs,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Default: results/bench."),
    ] = None,
    units: UnitsByKind = None,
    full: Annotated[
        bool, typer.Option("--full", help="All columns, and why figures are not there.")
    ] = False,
    json_: AsJson = False,
) -> None:
    """Put drives of any families on one bench: a row for each, and their curves on the same axes.

    Mass, room, efficiency forwards and backwards over load and speed, torques without load and from rest,
    stiffness, backlash, lost motion, inertia and ripple, each as `run` has it. The folder holds bench.html,
    bench.csv and bench.json.
    """
    from pitchpoint.results.chosen_units import shown_in
    from pitchpoint.runs.bench import bench as benched
    from pitchpoint.views.bench import bench_screen, write_bench

    _demand_names(designs)
    folder = output or Path("results") / "bench"
    with _progress(None) as progress:
        drives = benched(designs, progress=progress)
    with shown_in(_units(units) if units else {}):
        page = write_bench(drives, folder)
        if json_:
            _emit(drives.as_json())
            return
        console = _console()
        for line in bench_screen(drives, console.width, str(page), full=full):
            console.print(_plain_line(line.text), style=_STYLES[line.style], soft_wrap=True)


@app.command()
def compare(
    designs: Designs,
    variant: Annotated[
        str | None,
        typer.Option(
            "--variant",
            help="Of a published case; as_published by default.",
            autocompletion=_variants_from,
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", metavar="DIR", help="Of several designs; results/A-B by default."
        ),
    ] = None,
    units: UnitsByKind = None,
    overwrite: Overwrite = False,
    full: Annotated[
        bool,
        typer.Option("--full", help="Print all results and inputs that differ, and every warning."),
    ] = False,
    json_: AsJson = False,
) -> None:
    """Compare designs, or a published case with its print.

    Several designs: main results with their differences, inputs that differ, and a report with their
    curves on the same axes. One published case: exit status 1 when a row misses without a known cause.
    """
    from pitchpoint.runs.compared_designs import resolved_reference

    _demand_names(designs)
    if len(designs) > 1:
        if variant is not None:
            raise InputError("goes with one case; of several write case@variant", key="--variant")
        outcomes, report = _compared_designs(designs, output, overwrite, units)
        if json_:
            _emit_designs(outcomes)
            return
        with _shown_units(outcomes, _units(units) if units else None):
            _designs_in_full(outcomes, report) if full else _designs_at_first(outcomes, report)
        return
    if units:
        raise InputError("goes with several designs; print has its own units", key="--units")
    if full:
        raise InputError("goes with several designs; a print is told in full", key="--full")
    one = resolved_reference(designs[0])
    _compare_with_print(one.case, variant or one.variant, json_)


_BETWEEN = ("vs", "vs.", "and", "with", "to", "against")
"""Words that people put between designs."""


def _demand_names(designs: list[str]) -> None:
    """InputError for a word between designs, or designs in one word, where no file has that name."""
    for one in designs:
        if (one.lower() in _BETWEEN or "," in one) and not os.path.exists(one):
            told = "is no design; name them one after the other: pitchpoint compare A B"
            raise InputError(f"{visible(shorten(one))} {told}")


def _compared_designs(
    designs: list[str], output: Path | None, overwrite: bool, units: list[str] | None
) -> "tuple[dict[str, Outcome], str]":
    """Results of designs by name, and the report that was written of them."""
    from pitchpoint.runs.compared_designs import DESIGNS, folder_of
    from pitchpoint.runs.compared_designs import designs as compared

    chosen = _units(units) if units else None
    folder = output or folder_of(designs, Path("results"))
    with _progress(folder) as progress:
        outcomes = compared(
            designs, folder=folder / DESIGNS, overwrite=overwrite, progress=progress
        )
        progress.part("", "report", False)
        _write_report(outcomes, folder, designs=True, units=chosen)
    return outcomes, f"Report: {folder / 'report.html'}"


def _emit_designs(outcomes: "dict[str, Outcome]") -> None:
    from pitchpoint.runs.compared_designs import as_json

    _emit({**as_json(outcomes), "designs": {n: _figures(one) for n, one in outcomes.items()}})


def _designs_at_first(outcomes: "dict[str, Outcome]", report: str) -> None:
    from pitchpoint.views.designs_screen import designs_screen

    console = _console()
    for line in designs_screen(outcomes, report, console.width):
        console.print(_plain_line(line.text), style=_STYLES[line.style], soft_wrap=True)


def _designs_in_full(outcomes: "dict[str, Outcome]", report: str) -> None:
    """What cannot be, results with their differences, inputs that differ, and what warns of each design."""
    from pitchpoint.views.designs import (
        differing,
        law_words,
        named_inputs,
        of_several,
        result_table,
    )

    for name, outcome in outcomes.items():
        _failing(f"{name}: {text}" for text in outcome.manifest["implausible"])
    _console().print(_plain(law_words(outcomes)))
    results = result_table(outcomes)
    for title, whole in {"Results": results, **differing(outcomes)}.items():
        table, alone = of_several(whole, len(outcomes))
        _console().print(f"\n[bold]{title}[/]" if whole.rows else f"\n[bold]{title}[/]: none")
        head, rows = tuple(table.head), table.rows
        if table.names > 1:  # one column of names stays beside values that go on below
            head, rows = ("input", *head[table.names :]), named_inputs(table)
        _table([dict(zip(head, row, strict=True)) for row in rows], head)
        if alone:
            _console().print(
                f"{alone} more that one design alone has are in the report.", style="dim"
            )
    for name, outcome in outcomes.items():
        _warn([f"{name}: {text}" for text in outcome.manifest["warnings"]])
    _console().print(_plain(report))


def _compare_with_print(case: str, variant: str | None, json_: bool) -> None:
    from pitchpoint.runs.run import compare_case

    name, chosen, rows = compare_case(case, variant, _progress)
    if json_:
        keep = [
            "quantity",
            "where",
            "printed",
            "computed",
            "tolerance",
            "kind",
            "verdict",
            "reason",
            "expected_miss",
            "unit",
            "bound",
        ]
        flat = [{key: row.as_json()[key] for key in keep} for row in rows]
        _emit({"case": name, "variant": chosen, "rows": flat})
    else:
        _rows(rows)
        _verdicts(rows)
    if any(row.surprises for row in rows):
        raise SystemExit(1)


@app.command()
def export(
    result: Result,
    csv: Annotated[bool, typer.Option("--csv", help="A file for each table.")] = False,
    mat: Annotated[bool, typer.Option("--mat", help="A file for MATLAB and Octave.")] = False,
    json_: Annotated[bool, typer.Option("--json", help="One JSON file.")] = False,
    xlsx: Annotated[bool, typer.Option("--xlsx", help="A workbook.")] = False,
    evaluator: Annotated[
        bool,
        typer.Option(
            "--evaluator", help="The loss map of the output as Python and C that need nothing."
        ),
    ] = False,
    mujoco: Annotated[
        bool,
        typer.Option(
            "--mujoco", help="A joint of MuJoCo: MJCF, and friction that follows the load."
        ),
    ] = False,
    urdf: Annotated[
        bool, typer.Option("--urdf", help="A joint of URDF: friction, damping, limits.")
    ] = False,
    ros2_control: Annotated[
        bool, typer.Option("--ros2-control", help="A transmission of ros2_control: its ratio.")
    ] = False,
    isaac: Annotated[
        bool, typer.Option("--isaac", help="Friction and armature for Isaac Lab on PhysX.")
    ] = False,
    modelica: Annotated[
        bool,
        typer.Option("--modelica", help="A package of Modelica: LossyGear, and the map itself."),
    ] = False,
    fmu: Annotated[
        bool, typer.Option("--fmu", help="The loss map as a unit of FMI 2.0 for co-simulation.")
    ] = False,
    fmu_joint: Annotated[
        bool,
        typer.Option(
            "--fmu-joint", help="The same with states: rotor, load, stiction, wind-up, play."
        ),
    ] = False,
    simscape: Annotated[
        bool, typer.Option("--simscape", help="The loss map as a lookup for MATLAB and Simulink.")
    ] = False,
    law: Annotated[
        str | None,
        typer.Option(
            "--law", metavar="NAME", help="Friction law of a joint; the first by default."
        ),
    ] = None,
    rotor_inertia: Annotated[
        str | None,
        typer.Option(metavar="QUANTITY", help='Of the motor, for the armature: "0.3 kg cm2".'),
    ] = None,
    load: Annotated[
        str | None,
        typer.Option(
            metavar="QUANTITY", help="At which a friction without load is right; of operation."
        ),
    ] = None,
    temperature: Annotated[
        str | None,
        typer.Option(metavar="QUANTITY", help="Of the oil in a joint; that of operation."),
    ] = None,
    torque_range: Annotated[
        str | None,
        typer.Option(
            metavar="LEAST:LARGEST",
            help='Torques of the output that friction is fitted to: "2 N m:20 N m".',
        ),
    ] = None,
    speed_range: Annotated[
        str | None,
        typer.Option(
            metavar="LEAST:LARGEST", help='Speeds of the output likewise: "1 rpm:30 rpm".'
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Default: export in the result."),
    ] = None,
    si: Annotated[bool, typer.Option("--si", help="SI units, not those of the report.")] = False,
    units: UnitsByKind = None,
) -> None:
    """Write a result for other programs.

    Tables come with a README.txt that says what is in them. An evaluator gives loss, efficiency and torque of
    the driver at any torque and speed of the output; it is of a run with --set loss_map.quadrants=4, as are
    joints for simulators, which go into a folder of their own each, with a table of what is lost.
    """
    from pitchpoint.runs.run import open_outcomes

    asked = {"csv": csv, "mat": mat, "json": json_, "xlsx": xlsx, "evaluator": evaluator}
    formats = [name for name, wanted in asked.items() if wanted]
    joints = {"mujoco": mujoco, "urdf": urdf, "ros2_control": ros2_control, "isaac": isaac}
    joints |= {"modelica": modelica, "fmu": fmu, "fmu_joint": fmu_joint, "simscape": simscape}
    targets = [name for name, wanted in joints.items() if wanted]
    outcomes, folder = open_outcomes(result), output or Path(result) / "export"
    if formats or not targets:
        from pitchpoint.exports.files import export as exported

        chosen = _units(units) if units else None
        for path in exported(outcomes, folder, formats, si=si, units=chosen):
            typer.echo(visible(str(path)))
    if targets:
        from pitchpoint.exports.simulators import Asked, hand_over

        wishes = Asked(law, rotor_inertia, load, temperature, torque_range, speed_range)
        for name, handed in hand_over(outcomes, folder, targets, wishes).items():
            typer.echo(visible(f"{name}:"))
            for line in (*map(str, handed.paths), *handed.lost):
                typer.echo(visible(line))


@app.command()
def duty(
    result: Result,
    cycle: Annotated[
        Path,
        typer.Argument(
            metavar="CYCLE",
            help="Comma separated values with heads such as time \\[s], torque \\[N m], speed \\[rpm], "
            "and temperature \\[degC] where it changes.",
        ),
    ],
    variant: Annotated[str | None, typer.Option("--variant", help="Of the result.")] = None,
    law: Annotated[
        str,
        typer.Option(
            "--law",
            help="Of friction; by default the first one, with energies under all beside it.",
        ),
    ] = "",
    teeth: Annotated[
        bool, typer.Option("--teeth", help="With damage and life of the teeth by ISO 6336.")
    ] = False,
    json_: AsJson = False,
) -> None:
    """Energy, torques and loss of a drive over a duty cycle of its output.

    Torque is that of the output on its load, positive along positive speeds. The result is one of a run with
    --set loss_map.quadrants=4. Motor, heat and rated lives are added by the table duty of the case file, or
    from Python, see `docs duty`.
    """
    from pitchpoint.notebook.duty_cycle import duty as over_cycle
    from pitchpoint.notebook.result import open_result
    from pitchpoint.views.duty_cycle import duty_screen

    data = over_cycle(open_result(result), cycle, variant=variant, law=law, teeth=teeth)
    if json_:
        every = [*data, *data.coords]
        figures = {n: data[n].values.tolist() for n in every if "time" not in data[n].dims}
        _emit({**figures, **{name: data.attrs[name] for name in ("first_to_fail", "left_out")}})
        return
    console = _console()
    for line in duty_screen(data, console.width):
        console.print(_plain_line(line.text), style=_STYLES[line.style], soft_wrap=True)


@app.command("open")
def open_(
    result: Result,
    print_: Annotated[bool, typer.Option("--print", help="Only tell where it is.")] = False,
) -> None:
    """Show the report of a result, a study or a sizing in the browser."""
    import webbrowser

    report = Path(result) / "report.html"
    if not os.path.isfile(report):
        raise InputError("holds no report.html; run its case, which writes one", file=result)
    if print_ or not webbrowser.open(report.resolve().as_uri()):
        typer.echo(visible(str(report.resolve())))


@app.command()
def cite(
    result: Annotated[
        str,
        typer.Argument(
            metavar="RESULT", help="Folder that `run` wrote, a shipped case, or a file."
        ),
    ],
    bibtex: Annotated[bool, typer.Option("--bibtex", help="BibTeX entries.")] = False,
    json_: AsJson = False,
) -> None:
    """List the sources behind a result or a case, with what rests on each, and the program."""
    from pitchpoint import __version__, citations
    from pitchpoint.cases.record import sources_of
    from pitchpoint.runs.run import manifests

    sources = sources_of(manifests(result))
    if json_:
        _emit(sources)
        return
    for source in sources:
        of = f" [{source['of']}]" if source["of"] else ""
        line = visible(f"{source['key']}: {source['text']}{of}")
        typer.echo(citations.bibtex(source["key"]) if bibtex else line)
    typer.echo(citations.of_program(__version__, bibtex=bibtex))


def _laws_from(incomplete: str) -> list[str]:
    """Kinds and names of laws that begin so."""
    from pitchpoint.runs.catalogue import entries

    every = dict.fromkeys(word for row in entries() for word in (row["kind"], row["name"]))
    return [word for word in every if word.startswith(incomplete)]


@app.command()
def models(
    which: Annotated[
        str | None,
        typer.Argument(
            metavar="[KIND|NAME]",
            help="A kind, such as friction, lists its laws; a name shows the sheet of that law.",
            autocompletion=_laws_from,
        ),
    ] = None,
    matrix: Annotated[
        bool, typer.Option("--matrix", help="Which analysis there is for which family, or why not.")
    ] = False,
    json_: AsJson = False,
) -> None:
    """List laws, oils and materials, or show one."""
    if matrix:
        _show_matrix(json_)
        return
    from pitchpoint.runs.catalogue import entries, matching

    rows = entries() if which is None else matching(which)
    if json_:
        _emit(rows)
    elif which is None:
        _kinds_of_laws(rows)
    elif which in {row["kind"] for row in rows}:
        _table(rows, ("name", "title", "range"))
        _console().print(f"\nA law whole, with its sources: pitchpoint models {rows[0]['name']}")
    else:
        for row in rows:
            _table([{"": key, "law": text} for key, text in row.items() if text], ("", "law"))


def _kinds_of_laws(rows: Sequence[Mapping[str, str]]) -> None:
    """Each kind with the names in it."""
    kinds: dict[str, list[str]] = {}
    for row in rows:
        kinds.setdefault(row["kind"], []).append(row["name"])
    _table(
        [{"kind": kind, "names": ", ".join(names)} for kind, names in kinds.items()],
        ("kind", "names"),
    )
    _console().print("\nOne kind with titles and ranges: pitchpoint models friction")


@app.command()
def schema(
    of: Annotated[
        str,
        typer.Argument(metavar="case|size", help="Of case files, or of tasks for a sizing."),
    ] = "case",
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="FILE", help="Default: the screen.")
    ] = None,
) -> None:
    """Print the JSON Schema of case files, or of tasks.

    Editors complete and check TOML by it. A file names it in its first line: #:schema pitchpoint.json
    """
    from pitchpoint.cases.json_schema import case_schema, table_schema
    from pitchpoint.input.quantities import shown
    from pitchpoint.sizing.task_table import TASK_TABLE, Task

    if of not in ("case", TASK_TABLE):
        raise InputError(f"{shown(of)} has no schema; known are case and {TASK_TABLE}")
    of_task = of == TASK_TABLE
    made = table_schema("Task of Pitchpoint", TASK_TABLE, Task) if of_task else case_schema()
    _write(json.dumps(made, indent=1, ensure_ascii=False) + "\n", output)


def _pages_from(incomplete: str) -> list[str]:
    """Pages that begin so."""
    from pitchpoint.core.pages import page_names

    return [name for name in page_names() if name.startswith(incomplete)]


@app.command()
def docs(
    words: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[PAGE | WORD...]",
            help="Print this page, or list where these words are; none lists all pages.",
            autocompletion=_pages_from,
        ),
    ] = None,
    json_: AsJson = False,
) -> None:
    """Read the documentation in the terminal, or search it.

    Into a file or a pipe a page goes as Markdown.
    """
    from pitchpoint.core import pages

    page = " ".join(words or [])
    if page and "/" not in page and not pages.is_page(page) and (found := pages.search_pages(page)):
        _show_found(found, json_)
    elif not words:
        _show(
            [{"page": one, "title": pages.title(one)} for one in pages.page_names()],
            json_,
            ("page", "title"),
        )
    elif json_:
        _emit({"page": page, "text": pages.page_text(page)})
    elif sys.stdout.isatty():
        from rich.markdown import Markdown

        _console().print(Markdown(pages.page_text(page), hyperlinks=False))
    else:
        typer.echo(pages.page_text(page), nl=False)


def _show_found(found: list[dict[str, str]], as_json: bool) -> None:
    """Places of a search, a line each."""
    from pitchpoint.views.show import first_clauses

    if as_json:
        _emit(found)
        return
    width = max(len(one["page"]) for one in found)
    lacking = ""
    for one in found:
        if one.get("without", "") != lacking:
            first, lacking = not lacking, one["without"]
            typer.echo(visible(f"{'No page has all of these words. ' * first}Without {lacking}:"))
        line = first_clauses(one["line"], max(_console().width - width - 2, _LEAST))
        typer.echo(f"{one['page']:<{width}}  {line}")


_LEAST = 30
"""Characters of a line that a search shows at least."""


def _families_from(incomplete: str) -> list[str]:
    """Families that begin so."""
    from pitchpoint.cases.template import FAMILIES

    return [name for name in FAMILIES if name.startswith(incomplete)]


@app.command()
def new(
    family: Annotated[
        str,
        typer.Argument(
            metavar="FAMILY",
            help="spur, helical, strain_wave, rack_and_pinion, torus, ball_on_disc, two_stages, "
            "planetary, 3K, or size for a task.",
            autocompletion=_families_from,
        ),
    ],
    ratio: Annotated[
        str | None,
        typer.Option(
            help="Of strain_wave, planetary and 3K: teeth for this ratio, input over output."
        ),
    ] = None,
    torque: Annotated[
        str | None,
        typer.Option(help='With --ratio: a module that bears it at the output, "20 N m".'),
    ] = None,
    speed: Annotated[
        str | None, typer.Option(help='With --torque: of the output, "30 rpm".')
    ] = None,
    life: Annotated[
        str | None, typer.Option(help='With --torque: time under load, "5000 h".')
    ] = None,
    diameter: Annotated[
        str | None,
        typer.Option(help='With --torque: largest one around the gears, "120 mm".'),
    ] = None,
    planets: Annotated[
        int | None, typer.Option(help="With --ratio: number of planets, 3 unless given.")
    ] = None,
    count: Annotated[
        int | None,
        typer.Option(
            help="With --ratio: at most so many sets as variants of the file; those nearest to the "
            "ratio first, of 3K those that lose least."
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE", help="Default: the screen, as for -."),
    ] = None,
) -> None:
    """Write a case file to begin with.

    It runs as it is; every optional key is a remark in it.
    """
    from pitchpoint.cases.template import template
    from pitchpoint.sizing.task_table import TASK_TABLE, task_template

    beside = {"torque": torque, "planets": planets, "count": count}
    beside |= {"speed": speed, "life": life, "diameter": diameter}
    if family == TASK_TABLE:
        for key, value in {"ratio": ratio, **beside}.items():
            if value is not None:
                raise InputError("is no option of a task, whose file has what is asked", key=key)
        _write(task_template(), output)
        return
    if ratio is None:
        for key, value in beside.items():
            if value is not None:
                raise InputError("goes with --ratio; the file has its own", key=key)
        _write(template(family), output)
        return
    from pitchpoint.sizing.for_ratio import case_for_ratio

    _write(
        case_for_ratio(
            family,
            _ratio(ratio),
            torque=torque,
            planets=planets,
            count=1 if count is None else count,
            speed=speed,
            life=life,
            diameter=diameter,
        ),
        output,
    )


@app.command()
def size(
    task: Annotated[
        Path | None,
        typer.Argument(
            metavar="FILE",
            help="What follows as keys of a table size; options win over its values.",
        ),
    ] = None,
    torque: Annotated[str | None, typer.Option(help='At the output, "60 N m".')] = None,
    ratio: Annotated[
        str | None, typer.Option(help="Speed of the input over that of the output.")
    ] = None,
    speed: Annotated[str | None, typer.Option(help='Of the output, "30 rpm".')] = None,
    life: Annotated[str | None, typer.Option(help='Time under load, "5000 h".')] = None,
    ratio_tolerance: Annotated[
        str | None, typer.Option(help="Part by which the ratio may differ; 0.03 unless given.")
    ] = None,
    diameter: Annotated[
        str | None, typer.Option(help='Largest one around the gears, "120 mm".')
    ] = None,
    length: Annotated[str | None, typer.Option(help="Largest one of the gears.")] = None,
    centre_distances: Annotated[
        str | None,
        typer.Option(help='Largest ones of stages from the input, or one: "53 mm, 57 mm, 77 mm".'),
    ] = None,
    families: Annotated[
        str | None,
        typer.Option(help='Which are tried, "two stages, planetary, 3K"; all unless given.'),
    ] = None,
    planets: Annotated[
        str | None, typer.Option(help='How many a set may have, "3, 4"; 3 to 5 unless given.')
    ] = None,
    material: Annotated[str | None, typer.Option(help="Of gears; case-hardened-mq.")] = None,
    flank_safety: Annotated[str | None, typer.Option(help="Least one; 1.2 unless given.")] = None,
    root_safety: Annotated[str | None, typer.Option(help="Least one; 1.5 unless given.")] = None,
    application_factor: Annotated[
        str | None, typer.Option(help="K_A of the rating of teeth; 1 unless given.")
    ] = None,
    face_load_factor: Annotated[
        str | None, typer.Option(help="K_Hβ of the rating of teeth; 1 unless given.")
    ] = None,
    slenderness: Annotated[
        str | None,
        typer.Option(help="Largest face width over the pinion's diameter; 1.2 unless given."),
    ] = None,
    aims: Annotated[
        str | None, typer.Option(help="What counts; mass, loss, diameter, backlash unless given.")
    ] = None,
    lubricant: Annotated[str | None, typer.Option(help="Oil; pao-vg-150 unless given.")] = None,
    temperature: Annotated[
        str | None, typer.Option(help='Of the oil; "60 degC" unless given.')
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Folder for cases of the front."),
    ] = None,
    json_: AsJson = False,
) -> None:
    """Find drives for a torque, a ratio, a speed and a life.

    Stages of spur and helical pairs, planetary, stepped and 3K sets, strain
    wave gears alone or behind a set. Those are shown that bear the load and
    that no other one beats, each a case file that runs. Torque, ratio, speed
    and life are needed, as options or in a file: pitchpoint new size.
    """
    from pitchpoint.results.store import write_text
    from pitchpoint.sizing.sizing import Sizing, sized_for
    from pitchpoint.sizing.task_table import Task, read_task
    from pitchpoint.views.sizing_report import render_sizing
    from pitchpoint.views.sizing_screen import sizing_as_json, sizing_screen

    options: dict[str, Any] = {
        "torque": torque,
        "ratio": None if ratio is None else _ratio(ratio),
        "speed": speed,
        "life": life,
        "ratio_tolerance": ratio_tolerance,
        "diameter": diameter,
        "length": length,
        "centre_distances": centre_distances,
        "families": families,
        "planets": planets,
        "material": material,
        "flank_safety": flank_safety,
        "root_safety": root_safety,
        "application_factor": application_factor,
        "face_load_factor": face_load_factor,
        "slenderness": slenderness,
        "aims": aims,
        "lubricant": lubricant,
        "temperature": temperature,
    }
    asked = Task.read(**options) if task is None else read_task(task, **options)
    if output is not None:
        Sizing.demand_unused(output)
    found = sized_for(asked)
    if output is not None:
        found.write(output)
        write_text(output / "report.html", render_sizing(found, folder=output))
    if json_:
        _emit(sizing_as_json(found))
        return
    console = _console()
    for line in sizing_screen(found, console.width, output):
        console.print(_plain_line(line.text), style=_STYLES[line.style], soft_wrap=True)


def _ratio(text: str) -> float:
    """A ratio as it is written: 80, or 80:1."""
    from pitchpoint.input.quantities import shown

    first, colon, second = text.partition(":")
    try:
        return float(first) / (float(second) if colon else 1.0)
    except (ValueError, ZeroDivisionError):
        told = f"{shown(text)} is no ratio; write the input over the output, --ratio 80"
        raise InputError(told, key="--ratio") from None


def _write(text: str, path: Path | None) -> None:
    """Text into a file that is not there yet, or to the screen, for which "-" stands too."""
    if path is None or str(path) == "-":
        typer.echo(text, nl=False)
        return
    try:
        with path.open(
            "x", encoding="utf-8"
        ) as file:  # never through a link that leads nowhere yet
            file.write(text)
    except FileExistsError:
        raise InputError("is there already; give another name", file=str(path)) from None
    typer.echo(visible(str(path)))


def _show_matrix(as_json: bool) -> None:
    from pitchpoint.runs.matrix import matrix

    rows = matrix()
    _show(rows, as_json, tuple(rows[0])[1:])


def _settings(texts: list[str]) -> dict[str, Any]:
    from pitchpoint.input.quantities import shown

    settings = {}
    for text in texts:
        key, equals, value = text.partition("=")
        if not equals or not key.strip():
            raise InputError(
                f'{shown(text)} is not KEY=VALUE, such as operation.torque="60 N m"', key="--set"
            )
        settings[key.strip()] = _value(value.strip())
    return settings


def _value(text: str) -> Any:
    """TOML value where the text is one, else the text itself."""
    from pitchpoint.cases.document import parsed

    try:
        return parsed(f"value = {text}")["value"]
    except (ValueError, RecursionError):
        return text


def _studies(texts: list[str]) -> dict[str, "Study"]:
    from pitchpoint.cases.study_tables import Study
    from pitchpoint.input.quantities import shown

    studies: dict[str, Study] = {}
    for sweep in _sweeps(texts, "--sweep"):
        name = f"sweep_{sweep.key.replace('.', '_')}"
        if name in studies:
            raise InputError(f"{shown(sweep.key)} is swept twice", key="--sweep")
        studies[name] = Study(title=f"Sweep of {sweep.key}", sweep=sweep)
    return studies


def _sweeps(texts: list[str], option: str) -> "Iterator[Sweep]":
    from pitchpoint.cases.study_tables import Sweep, one_value
    from pitchpoint.input.quantities import shown

    for text in texts:
        given = _SWEEP.fullmatch(text)
        if given is None:
            raise InputError(
                f"{shown(text)} is not KEY=START:STOP:COUNT with a count of 1 to 100000, such as "
                '"operation.speed=500 rpm:3000 rpm:11"',
                key=option,
            )
        key, start, stop, count = map(str.strip, given.groups())
        if float(count) < 2 and start != stop:
            raise InputError(one_value(start, stop), key=option)
        yield Sweep(key=key, start=start, stop=stop, count=float(count))


def _values_over(texts: list[str], case: "Case") -> dict[str, Any]:
    """Values by key of a study: a range of numbers, two ends, or a list."""
    from pitchpoint.input.quantities import shown

    values: dict[str, Any] = {}
    for text in texts:
        key, equals, given = (part.strip() for part in text.partition("="))
        if not (key and equals and given):
            told = f"{shown(text)} is not KEY=VALUES, such as {_OPTIONS['--over']}"
            raise InputError(told, key="--over")
        if key in values:
            raise InputError(f"{shown(key)} was given twice", key="--over")
        values[key] = _listed(case, case.key(key), given, text)
    return values


def _listed(case: "Case", key: str, given: str, text: str) -> Any:
    if not given.startswith("[") and given.count(":") == 1:
        return [_value(end.strip()) for end in given.split(":")]
    if not given.startswith("[") and ":" in given:
        from pitchpoint.analyses.studies import sweep_values

        (sweep,) = _sweeps([text.replace(text.partition("=")[0], key, 1)], "--over")
        tree = case.held[0].document().tree
        return sweep_values(sweep, "--over", case.name, tree)[0]
    value = _value(given)
    return value if isinstance(value, list) else [value]


def _units(texts: list[str]) -> dict[str, str]:
    """Units by kind of quantity."""
    from pitchpoint.results.chosen_units import unit_choice

    try:
        return unit_choice(",".join(texts))
    except InputError as error:
        raise error.at(key="--units") from None


def _shown_units(
    outcomes: "dict[str, Outcome]", units: dict[str, str] | None = None
) -> AbstractContextManager[None]:
    """Units of what is printed: those given, else those of the first case."""
    from pitchpoint.results.chosen_units import shown_in
    from pitchpoint.views.inputs import recorded_units

    return shown_in(recorded_units(outcomes) if units is None else units)


def _write_report(
    outcomes: "dict[str, Outcome]",
    folder: Path,
    *,
    designs: bool = False,
    units: dict[str, str] | None = None,
) -> None:
    from pitchpoint.views.report import write_report

    write_report(outcomes, folder / "report.html", designs=designs, units=units)


@contextmanager
def _progress(folder: Path | None, kept: str = "parts") -> "Iterator[Progress]":
    """Progress: a moving line on a terminal, else a line for each part; what is on disk if interrupted."""
    from pitchpoint.runs.run import Progress

    console = _console(stderr=True)
    moving = sys.stderr.isatty() and not console.is_dumb_terminal
    status = console.status("reading", spinner="line") if moving else None

    class Shown(Progress):
        begun = expected = 0

        def expect(self, parts: int) -> None:
            self.expected += parts

        def part(self, variant: str, title: str, reused: bool) -> None:
            _look_for_garbage()  # what computes is imported by now
            self.begun += 1
            place = _place(self.begun, self.expected)
            self.title = f"{variant} {title}".strip() + (" (on disk)" if reused else "") + place
            if status is None:
                _complain(self.title)
            else:
                status.update(_plain(self.title))

        def points(self, done: int, doing: str = "") -> None:
            if status is not None:
                told = "; ".join(filter(None, (f"{done} points" if done else "", doing)))
                status.update(_plain(f"{self.title}: {told}" if told else self.title))

    shown = Shown()
    try:
        with status or nullcontext():
            yield shown
    except KeyboardInterrupt:
        if folder is None:
            raise
        done = (
            f"{max(shown.begun - 1, 0)} finished parts" if kept == "parts" else f"finished {kept}"
        )
        _complain(f"interrupted: {done} are in {folder}; the same command goes on from there")
        raise SystemExit(_INTERRUPTED) from None


def _place(number: int, of: int) -> str:
    """Which part of how many begins, and the share that is done; empty beyond those that are computed."""
    if number > of:
        return ""
    return f", part {number} of {of}, {100 * (number - 1) // of} %"


def _figures(outcome: "Outcome") -> dict[str, Any]:
    from pitchpoint.runs.catalogue import figures_by_law

    return figures_by_law(outcome)


def _summary(outcome: "Outcome", number: int) -> None:
    from pitchpoint.views.point import by_members
    from pitchpoint.views.section_registry import in_order

    _heading(outcome.manifest, number)
    for section in in_order():
        for printed in section.prints(outcome):
            _print(printed)
    _warn([by_members(outcome, text) for text in outcome.manifest["warnings"]])


def _heading(manifest: Mapping[str, Any], number: int) -> None:
    """What cannot be, before anything else is said of a variant; then its title."""
    if number:
        _console().print()
    _failing(manifest["implausible"])
    _console().print(f"[bold]{_plain(manifest['title'])}[/] ({_plain(manifest['variant'])})")


def _failing(sentences: Iterable[str]) -> None:
    for text in sentences:
        _console().print(_plain(text), style="bold red")


def _print(printed: "Printed") -> None:
    """A title, a table and a line, whichever there are."""
    if printed.title:
        _console().print(f"[bold]{_plain(printed.title)}[/]")
    if printed.rows:
        _table(printed.rows, tuple(printed.rows[0]))
    if printed.line:
        _console().print(_plain(printed.line))


def _rows(rows: "list[TargetRow]") -> None:
    from pitchpoint.views.show import number_text

    shown = [
        {
            "quantity": row.quantity,
            "verdict": row.verdict,
            "printed": f"{row.bound}{row.printed:g} {row.unit if row.unit != '1' else ''}",
            "computed": "" if row.computed is None else number_text(row.computed),
            "deviation": ""
            if row.deviation is None
            else f"{'+' * (row.deviation > 0.0)}{number_text(row.deviation, 2)}",
            "tolerance": "" if row.bound else f"{row.tolerance:g}",
            "kind": row.kind,
            "place": row.where,
        }
        for row in rows
    ]
    _table(shown, tuple(shown[0]) if shown else ())
    for row in rows:
        if row.reason and (row.verdict != "pass" or row.surprises):
            _console().print(_plain(f"{row.verdict}: {row.quantity}: {row.reason}"))


def _verdicts(rows: "list[TargetRow]", of: str = "") -> None:
    from pitchpoint.results.target_rows import counts, verdict_sentence

    if rows:
        _console().print(_plain(f"{of}{verdict_sentence(rows)}"))
    for kind, verdicts in counts(rows).items():
        told = ", ".join(f"{count} {verdict}" for verdict, count in verdicts.items())
        _console().print(_plain(f"{of}{kind}: {told}"))


def _show(rows: list[dict[str, str]], as_json: bool, columns: tuple[str, ...]) -> None:
    if as_json:
        _emit(rows)
    else:
        _table(rows, columns)


def _table(rows: Sequence[Mapping[str, str]], columns: tuple[str, ...]) -> None:
    from rich.markup import escape
    from rich.table import Column, Table

    from pitchpoint.views.columns import fitted

    used = [name for name in columns if any(row.get(name) for row in rows)]
    if not used:
        return
    console = _console()
    cells = [{name: _one_line(str(row.get(name, ""))) for name in used} for row in rows]
    for block in fitted(cells, used, console.width):
        heads = [Column(_plain(name), width=size, overflow="fold") for name, size in block.items()]
        table = Table(*heads, box=None, padding=(0, 1, 0, 0), pad_edge=False, header_style="bold")
        for row in cells:
            table.add_row(*(escape(row[name]) for name in block))
        console.print(table)


def _warn(warnings: list[str]) -> None:
    for text in warnings:
        _console().print(f"[yellow]warning:[/] {_plain(text)}")


def _emit(value: Any) -> None:
    from pitchpoint.results.store import without_nan

    typer.echo(json.dumps(without_nan(value), indent=1, allow_nan=False))


def _complain(text: str) -> None:
    """One line, whatever the names of files and keys are made of."""
    sys.stderr.write(f"{shorten(text.rstrip(), _LONGEST)}\n")


def _plain(text: str) -> str:
    """Text of others on one line: without rich's markup, and without what steers a terminal."""
    from rich.markup import escape

    return escape(_one_line(text))


def _one_line(text: str) -> str:
    """Text of others on one line, without what steers a terminal."""
    return visible(" ".join(text.split()))


def _plain_line(text: str) -> str:
    """The same of a line whose spaces align it with others."""
    from rich.markup import escape

    return escape(visible(text.replace("\u00a0", " ")))


def _console(stderr: bool = False) -> Any:
    from rich.console import Console

    stream = sys.stderr if stderr else sys.stdout
    # A file or a pipe has no width of its own.
    width = None if stream.isatty() else _columns()
    return Console(stderr=stderr, highlight=False, emoji=False, width=width)


def _columns() -> int:
    """Characters in a line where nothing else says how many."""
    columns = os.environ.get("COLUMNS", "")
    return int(columns) if columns.isdecimal() and 20 <= int(columns) <= 10_000 else 80
