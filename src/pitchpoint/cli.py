"""The command line. Numbers for machines go to stdout with --json, tables and progress to the terminal."""

import json
import re
import sys
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pitchpoint.errors import InputError, PitchpointError

if TYPE_CHECKING:
    from pitchpoint.cases.comparison import Row
    from pitchpoint.cases.run import Outcome, Progress
    from pitchpoint.cases.schema import Study

app = typer.Typer(
    help="Load, sliding, film, friction and efficiency where gear teeth touch.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)

_INTERRUPTED = 130
_COUNT = re.compile("[1-9][0-9]{0,4}|100000", re.ASCII)

CaseName = Annotated[str, typer.Argument(metavar="CASE", help="A shipped case, or a TOML file.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON to stdout instead of tables.")]
Variants = Annotated[
    list[str] | None, typer.Option("--variant", help="Run this variant only; may be repeated.")
]
Settings = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help='For example operation.torque="200 N m".'),
]
Sweeps = Annotated[
    list[str] | None,
    typer.Option(
        "--sweep",
        metavar="KEY=START:STOP:COUNT",
        help='For example operation.speed="500 rpm:3000 rpm:11".',
    ),
]
Folder = Annotated[
    Path | None,
    typer.Option("-o", "--output", metavar="DIR", help="Default: results/CASE."),
]
Overwrite = Annotated[
    bool, typer.Option("--overwrite", help="Replace the results of another case in the folder.")
]


def main() -> None:
    """Entry point: one sentence for what went wrong, and the exit status that goes with it."""
    try:
        status = app(standalone_mode=False) or 0
    except PitchpointError as error:
        _complain(f"error: {error}")
        status = error.exit_code
    except typer.TyperException as error:
        told = error.format_message().rstrip(".")
        if told:  # without arguments the help is all there is to say
            _complain(f"error: {told}; see pitchpoint --help")
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


@app.command()
def cases(json_: AsJson = False) -> None:
    """List the cases that ship with the package."""
    from pitchpoint.cases.library import find, names

    rows = [{"case": name, "title": str(find(name)[1].get("title", ""))} for name in names()]
    _show(rows, json_, ("case", "title"))


@app.command()
def show(
    case: CaseName, variant: Variants = None, set_: Settings = None, json_: AsJson = False
) -> None:
    """Show the inputs of a case as resolved, with their status, and its issues."""
    from pitchpoint.cases.run import describe

    manifests = describe(case, only=variant or [], settings=_settings(set_ or []))
    if json_:
        _emit(manifests)
        return
    for manifest in manifests:
        _console().print(f"\n[bold]{_plain(manifest['title'])}[/] ({manifest['variant']})")
        columns = ("table", "key", "value", "status", "where", "note")
        _table(manifest["inputs"], columns)
        _warn(manifest["warnings"])
    for issue in manifests[0]["issues"]:
        _console().print(f"- {_plain(issue['where'])}: {_plain(issue['issue'])}. ", end="")
        _console().print(_plain(issue["verdict"]), style="dim")


@app.command()
def run(
    case: CaseName,
    output: Folder = None,
    variant: Variants = None,
    set_: Settings = None,
    sweep: Sweeps = None,
    overwrite: Overwrite = False,
    json_: AsJson = False,
) -> None:
    """Compute a case: tables on screen, results and report.html in a folder."""
    from pitchpoint.cases.record import default_folder
    from pitchpoint.cases.run import run as compute

    settings, studies = _settings(set_ or []), _studies(sweep or [])
    folder = output or default_folder(case, Path("results"))
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
    if json_:
        _emit({name: _figures(outcome) for name, outcome in outcomes.items()})
        return
    for name, outcome in outcomes.items():
        _summary(name, outcome)
    measured = {name: outcome.rows for name, outcome in outcomes.items() if outcome.rows}
    for name, rows in measured.items():
        _verdicts(rows, f"{name}, " if len(measured) > 1 else "")
    _console().print(f"Report: {_plain(str(folder / 'report.html'))}")


@app.command()
def compare(
    case: CaseName,
    variant: Annotated[
        str | None, typer.Option("--variant", help="as_published by default.")
    ] = None,
    json_: AsJson = False,
) -> None:
    """Compare a published case with its print; exit status 1 when a row misses."""
    from pitchpoint.cases.run import compare_case

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
            "unit",
        ]
        flat = [{key: row.as_json()[key] for key in keep} for row in rows]
        _emit({"case": name, "variant": chosen, "rows": flat})
    else:
        _rows(rows)
        _verdicts(rows)
    if any(row.verdict == "miss" for row in rows):
        raise SystemExit(1)


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
    """List the sources behind a result or a case."""
    from pitchpoint import citations
    from pitchpoint.cases.run import manifests

    sources = {
        source["key"]: source["text"] for one in manifests(result) for source in one["sources"]
    }
    if json_:
        _emit([{"key": key, "text": text} for key, text in sources.items()])
        return
    for key, text in sources.items():
        typer.echo(citations.bibtex(key) if bibtex else f"{key}: {text}")


@app.command()
def models(json_: AsJson = False) -> None:
    """List the laws that can be chosen by name, with their ranges and sources."""
    from pitchpoint.cases.catalogue import entries

    columns = ("kind", "name", "title", "range", "sources", "note")
    _show(entries(), json_, columns)


def _settings(texts: list[str]) -> dict[str, Any]:
    settings = {}
    for text in texts:
        key, equals, value = text.partition("=")
        if not equals or not key.strip():
            raise InputError(f"'{text}' is not KEY=VALUE", key="--set")
        settings[key.strip()] = _value(value.strip())
    return settings


def _value(text: str) -> Any:
    """TOML value where the text is one, else the text itself."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (ValueError, RecursionError):
        return text


def _studies(texts: list[str]) -> dict[str, "Study"]:
    from pitchpoint.cases.schema import Study, Sweep

    studies: dict[str, Study] = {}
    for text in texts:
        key, _, grid = text.partition("=")
        parts = [part.strip() for part in grid.split(":")]
        if len(parts) != 3 or not _COUNT.fullmatch(parts[2]):
            raise InputError(
                f"'{text}' is not KEY=START:STOP:COUNT with a count of 1 to 100000", key="--sweep"
            )
        start, stop, count = parts
        sweep = Sweep(key=key.strip(), start=start, stop=stop, count=float(count))
        name = f"sweep_{key.strip().replace('.', '_')}"
        if name in studies:
            raise InputError(f"'{key.strip()}' is swept twice", key="--sweep")
        studies[name] = Study(title=f"Sweep of {key.strip()}", sweep=sweep)
    return studies


def _write_report(outcomes: "dict[str, Outcome]", folder: Path) -> None:
    from pitchpoint.views.report import write_report

    write_report(outcomes, folder / "report.html")


@contextmanager
def _progress(folder: Path | None) -> "Iterator[Progress]":
    """Progress on the terminal; says what is on disk when it is interrupted."""
    from pitchpoint.cases.run import Progress

    console = _console(stderr=True)

    class Shown(Progress):
        finished = 0

        def part(self, variant: str, title: str, reused: bool) -> None:
            self.finished += 1
            self.title = f"{variant} {title}".strip() + (" (on disk)" if reused else "")
            status.update(_plain(self.title))

        def points(self, done: int) -> None:
            status.update(_plain(f"{self.title}: {done} points"))

    with console.status("reading") as status:
        shown = Shown()
        try:
            yield shown
        except KeyboardInterrupt:
            status.stop()
            if folder is not None:
                _complain(
                    f"interrupted: {max(shown.finished - 1, 0)} finished parts are in {folder}; "
                    "the same command goes on from there"
                )
                raise SystemExit(130) from None
            raise


def _figures(outcome: "Outcome") -> dict[str, Any]:
    from pitchpoint.cases.catalogue import figures

    return figures(outcome)


def _summary(name: str, outcome: "Outcome") -> None:
    from pitchpoint.cases.catalogue import (
        kinematic_error_table,
        summary_table,
        sweep_tables,
        vibration_table,
        wind_up_table,
    )

    manifest = outcome.manifest
    _console().print(f"\n[bold]{_plain(manifest['title'])}[/] ({_plain(name)})")
    _console().print(_plain(f"Oil: {manifest['oil']}. Averages over: {manifest['averaging']}."))
    rows, columns, note = summary_table(outcome)
    _table(rows, columns)
    _console().print(_plain(note))
    for table in (vibration_table, wind_up_table, kinematic_error_table):
        rows, columns = table(outcome)
        if rows:
            _table(rows, columns)
    for title, points in sweep_tables(outcome):
        _console().print(f"[bold]{_plain(title)}[/]")
        _table(points, tuple(points[0]))
    _warn(manifest["warnings"])


def _rows(rows: "list[Row]") -> None:
    def number(value: float | None) -> str:
        return "" if value is None else f"{value:.5g}"

    shown = [
        {
            "quantity": row.quantity,
            "place": row.where,
            "printed": f"{row.bound}{row.printed:g} {row.unit if row.unit != '1' else ''}",
            "computed": number(row.computed),
            "deviation": "" if row.deviation is None else f"{row.deviation:+.2g}",
            "tolerance": "" if row.bound else f"{row.tolerance:g}",
            "kind": row.kind,
            "verdict": row.verdict,
        }
        for row in rows
    ]
    _table(shown, tuple(shown[0]) if shown else ())
    for row in rows:
        if row.verdict != "pass" and row.reason:
            _console().print(_plain(f"{row.verdict}: {row.quantity}: {row.reason}"))


def _verdicts(rows: "list[Row]", of: str = "") -> None:
    from pitchpoint.cases.comparison import counts

    for kind, verdicts in counts(rows).items():
        told = ", ".join(f"{count} {verdict}" for verdict, count in verdicts.items())
        _console().print(_plain(f"{of}{kind}: {told}"))


def _show(rows: list[dict[str, str]], as_json: bool, columns: tuple[str, ...]) -> None:
    if as_json:
        _emit(rows)
    else:
        _table(rows, columns)


def _table(rows: list[dict[str, str]], columns: tuple[str, ...]) -> None:
    from rich.table import Table

    used = [name for name in columns if any(row.get(name) for row in rows)]
    table = Table(*map(_plain, used), box=None, pad_edge=False, header_style="bold")
    for row in rows:
        table.add_row(*(_plain(str(row.get(name, ""))) for name in used))
    _console().print(table)


def _warn(warnings: list[str]) -> None:
    for text in warnings:
        _console().print(f"[yellow]warning:[/] {_plain(text)}")


def _emit(value: Any) -> None:
    from pitchpoint.results.store import without_nan

    typer.echo(json.dumps(without_nan(value), ensure_ascii=False, indent=1, allow_nan=False))


def _complain(text: str) -> None:
    """One line, whatever the names of files and keys are made of."""
    plain = "".join(sign if sign.isprintable() else ascii(sign)[1:-1] for sign in text.rstrip())
    sys.stderr.write(plain + "\n")


def _plain(text: str) -> str:
    """Text without rich's markup: what the user typed is shown as it is."""
    from rich.markup import escape

    return escape(text)


def _console(stderr: bool = False) -> Any:
    from rich.console import Console

    stream = sys.stderr if stderr else sys.stdout
    # A file or a pipe has no width; tables there keep their rows whole.
    return Console(stderr=stderr, highlight=False, width=None if stream.isatty() else 200)
