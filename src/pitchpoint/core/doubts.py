"""What is doubtful of a result, and what cannot be: sentences with what they move, the worst first.

A sentence is a `Doubt`. Which ones there are follows from checks, each registered with the `Checks` of the
place where it is asked: films of a line or a patch, the mesh cycle, the contacts of a mesh, a result.
"""

import json
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from inspect import getdoc
from typing import Any, Final, Generic, TypeVar

from pitchpoint.registry import enumerated

__all__ = [
    "BRIEF",
    "DOUBT_FIELDS",
    "FELT",
    "GUESSED",
    "LEFT_OUT",
    "REMARKED",
    "WITHHELD",
    "Check",
    "Checks",
    "Doubt",
    "as_doubt",
    "concerns",
    "doubts_of",
    "fails",
    "in_percent",
    "in_stage",
    "measured",
    "moves",
    "of_designs",
    "ranked_doubts",
    "reworded",
    "stored",
    "without_repeats",
    "worst_of_kinds",
]

BRIEF: Final = 70
"""Characters that "Doubtful: " leaves of a line of eighty."""

FELT: Final = 0.01
"""Part of the answer that a doubt has to move to be told."""

# Where nobody computes what a doubt moves, its nature ranks it among those that are computed.
WITHHELD: Final = 1.0
"""Rank of what has no number at all."""

GUESSED: Final = 0.3
"""Rank of a formula far from what it was fitted to: friction laws disagree by about so much there."""

LEFT_OUT: Final = 0.1
"""Rank of an effect that is left out, and of what says nothing of itself."""

REMARKED: Final = 0.02
"""Rank of what hardly moves a number, but has to be known."""

_FAILS = "Fails: "
_STAGE = re.compile(r"(?:(?<=^Stage )|(?<=^Fails: stage ))\d+(?: \([^()]+\))?(?=: )")
_GEAR = re.compile(r"(?<=\b[Gg]ear )\d\b")


class Doubt(str):
    """A sentence of a kind, with its extent and what it moves.

    Args:
        sentence: with its numbers.
        kind: what sentences have in common of which the worst one says enough; a plain one is its own.
        extent: larger is worse; comparable within a kind.
        moves: part of the answer that it moves; where nobody knows, a rank from `WITHHELD` to `REMARKED`.
        about: variables that it is about; empty where it is about all of a result.
        brief: number and consequence in at most `BRIEF` characters, for a screen; the sentence itself where
            that is as short.

    Example:
        >>> from pitchpoint.core.doubts import Doubt
        >>> told = Doubt("the grid is coarse: off by 5 %", "grid", 0.05, moves=0.05)
        >>> print(told, told.kind, told.extent)
        the grid is coarse: off by 5 % grid 0.05
    """

    kind: str
    extent: float
    moves: float
    about: tuple[str, ...]
    brief: str

    def __new__(
        cls,
        sentence: str,
        kind: str = "",
        extent: float = 0.0,
        *,
        moves: float = LEFT_OUT,
        about: tuple[str, ...] = (),
        brief: str = "",
    ) -> "Doubt":
        """See the class."""
        doubt = super().__new__(cls, sentence)
        doubt.kind, doubt.extent, doubt.moves = kind or str(sentence), float(extent), float(moves)
        doubt.about, doubt.brief = about, brief or str(sentence)
        return doubt

    def __getnewargs_ex__(self) -> tuple[tuple[str, str, float], dict[str, Any]]:
        """What copies are made of."""
        named = {"moves": self.moves, "about": self.about, "brief": self.brief}
        return (str(self), self.kind, self.extent), named


Looked = TypeVar("Looked")
Asks = TypeVar("Asks", bound=Callable[[Any], Iterable[str] | str | None])


@dataclass(frozen=True)
class Check(Generic[Looked]):
    """One question of what was computed.

    Attributes:
        asks: what is doubtful, or cannot be: a sentence, several, or none. Its docstring begins with what it
            looks at; the paragraphs below are the criterion and what that rests on.
        sources: keys of the bibliography.
    """

    asks: Callable[[Looked], Iterable[str] | str | None]
    sources: tuple[str, ...]

    @property
    def criterion(self) -> str:
        """From when on it tells something, and why from then on."""
        return " ".join((getdoc(self.asks) or "").partition("\n\n")[2].split())


class Checks(Generic[Looked]):
    """All that is asked at one place of a result, in the order in which it stands there.

    Args:
        place: that they are about.
        fails: True where they tell what cannot be; they give their sentences without the stop then.

    Example:
        >>> from pitchpoint.core.doubts import Checks
        >>> checks = Checks[float]("the teeth", fails=True)
        >>> @checks.add("iso_6336_5_2016")
        ... def heat(temperature):
        ...     "Temperature of steel."
        ...     return "the teeth melt" if temperature > 1800.0 else None
        >>> checks.of(2000.0), checks.of(300.0)
        (['Fails: the teeth melt.'], [])
    """

    def __init__(self, place: str, *, fails: bool = False) -> None:
        self.place, self._fails, self._checks = place, fails, list[Check[Looked]]()

    def __iter__(self) -> Iterator[Check[Looked]]:
        """Checks in order."""
        return iter(self._checks)

    def add(self, *sources: str) -> Callable[[Asks], Asks]:
        """Register a function as a check.

        Args:
            sources: keys of the bibliography.
        """

        def registered(asks: Asks) -> Asks:
            self._checks.append(Check(asks, sources))
            return asks

        return registered

    def of(self, computed: Looked) -> list[Doubt]:
        """All that the checks say of what was computed."""
        answers = (check.asks(computed) or () for check in self._checks)
        every = (text for told in answers for text in ([told] if isinstance(told, str) else told))
        if self._fails:
            return [fails(reworded(text, "{}.".format)) for text in every]
        return [*map(as_doubt, every)]


def as_doubt(sentence: str) -> Doubt:
    """Sentence as a doubt; a plain one is of its own kind."""
    return sentence if isinstance(sentence, Doubt) else Doubt(sentence)


def moves(sentence: str) -> float:
    """Part of the answer that a sentence moves, or the rank of its nature."""
    return as_doubt(sentence).moves


def reworded(
    sentence: str,
    change: Callable[[str], str],
    change_brief: Callable[[str], str] | None = None,
) -> Doubt:
    """The same doubt with its sentence changed, and its brief alike where nothing else is said.

    Example:
        >>> from pitchpoint.core.doubts import Doubt
        >>> tips = Doubt("the tips of its teeth are thin", brief="thin tips")
        >>> reworded(tips, "Gear 2: {}.".format).brief
        'Gear 2: thin tips.'
    """
    doubt = as_doubt(sentence)
    return _alike(doubt, change(doubt), (change_brief or change)(doubt.brief))


def _alike(doubt: Doubt, sentence: str, brief: str) -> Doubt:
    """Other words for the same doubt."""
    return Doubt(
        sentence, doubt.kind, doubt.extent, moves=doubt.moves, about=doubt.about, brief=brief
    )


def concerns(sentence: str, there: Collection[str]) -> bool:
    """True for a sentence on all of a result, and for one on variables of which one is there."""
    about = as_doubt(sentence).about
    return not about or any(name in there for name in about)


def fails(sentence: str, brief: str = "") -> Doubt:
    """Sentence marked as one on what cannot be; whoever warns of a result may tell such ones.

    Args:
        sentence: with its stop.
        brief: see `Doubt`; that of the sentence where it has one.

    Example:
        >>> fails("the teeth of gear 2 melt.")
        'Fails: the teeth of gear 2 melt.'
    """
    doubt = as_doubt(sentence)
    return _alike(doubt, f"{_FAILS}{doubt}", f"{_FAILS}{brief or doubt.brief}")


_SMALLER = (("", 1.0), ("m", 1e3), ("µ", 1e6), ("n", 1e9))
"""Prefixes of units and how many there are in one."""


def measured(value: float, unit: str) -> str:
    """A value with four digits, in a unit with a prefix where it would need more than two zeros.

    Args:
        value: not negative [unit].
        unit: that takes prefixes, such as "N m", "N" or "m".

    Example:
        >>> from pitchpoint.core.doubts import measured
        >>> measured(0.000259, "N m"), measured(0.0171234, "N m"), measured(2e-14, "m")
        ('0.259 mN m', '0.01712 N m', 'less than 0.001 nm')
    """
    for prefix, times in _SMALLER:
        if value * times >= _LEAST or value == 0.0:
            return f"{value * times:.4g} {prefix}{unit}"
    return f"less than {_LEAST:g} {_SMALLER[-1][0]}{unit}"


_LEAST = 1e-3
"""Least number that is written without a smaller unit."""


def in_percent(part: float) -> str:
    """A part as a percentage of two digits, without a power of ten.

    Example:
        >>> in_percent(0.0321), in_percent(0.9996), in_percent(1.26)
        ('3.2 %', '100 %', '130 %')
    """
    return f"{float(f'{100.0 * part:.2g}'):g} %"


def in_stage(number: int | str, sentence: str) -> Doubt:
    """Sentence on one stage of a drive, or on a mesh in it, "1 (sun and planet)", say.

    Example:
        >>> from pitchpoint.core.doubts import fails
        >>> in_stage(2, fails("the teeth of gear 2 melt."))
        'Fails: stage 2: the teeth of gear 2 melt.'
        >>> in_stage(1, "Tips are pointed."), in_stage(1, "K_v ends here.")
        ('Stage 1: tips are pointed.', 'Stage 1: K_v ends here.')
    """
    return reworded(sentence, partial(_stage_words, number))


def _stage_words(number: int | str, sentence: str) -> str:
    """Words on a stage."""
    if sentence.startswith(_FAILS):
        return f"{_FAILS}stage {number}: {sentence.removeprefix(_FAILS)}"
    symbol = sentence[1:2] == "_" or sentence[1:2].isupper()  # K_v, ISO
    return f"Stage {number}: {sentence if symbol else sentence[:1].lower() + sentence[1:]}"


def of_designs(sentence: str, names: str) -> Doubt:
    """Sentence on some designs or variants by their names.

    Example:
        >>> from pitchpoint.core.doubts import fails
        >>> of_designs(fails("teeth melt."), "cold and hot")
        'Fails: cold and hot: teeth melt.'
    """

    def named(text: str) -> str:
        begin = _FAILS if text.startswith(_FAILS) else ""
        return f"{begin}{names}: {text.removeprefix(begin)}"

    return reworded(sentence, named)


def ranked_doubts(sentences: Iterable[str]) -> dict[str, list[str]]:
    """Sentences on what cannot be, and all other warnings that are felt, each once and the worst first.

    Sentences that differ by their stage or gear alone become one.

    Example:
        >>> from pitchpoint.core.doubts import Doubt, fails
        >>> grid = Doubt("the grid is off by 20 %.", moves=0.2)
        >>> tips = [f"the teeth of gear {number} are pointed." for number in (1, 2)]
        >>> ranked_doubts([*tips, fails("teeth melt."), grid, Doubt("a trifle.", moves=1e-4)])["warnings"]
        ['the grid is off by 20 %.', 'the teeth of gear 1 (gear 2 alike) are pointed.']
    """
    every = without_repeats(sentences)
    failing: list[str] = [text for text in every if text.startswith(_FAILS)]
    felt: Iterable[str] = (
        text
        for text in every
        if not text.startswith(_FAILS)
        and moves(text) >= FELT
        and not any(text.rstrip(".") in other for other in failing)
    )
    ranked: list[str] = sorted(felt, key=moves, reverse=True)
    return {"implausible": failing, "warnings": ranked}


def without_repeats(sentences: Iterable[str]) -> list[Doubt]:
    """Sentences that differ by their stage or gear alone as one.

    Example:
        >>> without_repeats(["Stage 1: K_A = 1.", "Stage 2: K_A = 1.", "Stage 2: Z_W = 1."])
        ['Stages 1 and 2: K_A = 1.', 'Stage 2: Z_W = 1.']
        >>> without_repeats([f"Stage {n} (sun and planet): Z_W = 1." for n in (1, 2)])
        ['Stages 1 and 2 (sun and planet): Z_W = 1.']
        >>> without_repeats([f"Stage 1 ({mesh}): K_A = 1." for mesh in ("sun and planet", "planet and ring")])
        ['Stage 1 (sun and planet; planet and ring): K_A = 1.']
    """
    return _merged(_merged(sentences, _STAGE, _stages), _GEAR, _gears)


DOUBT_FIELDS: Final = ("kind", "extent", "moves", "about", "brief")
"""What is stored beside each sentence, see `Doubt`."""


def stored(sentences: Iterable[str]) -> dict[str, str]:
    """Attributes of a dataset that hold sentences and what they move."""
    every = [as_doubt(text) for text in sentences]
    rest = [[getattr(one, name) for name in DOUBT_FIELDS] for one in every]
    return {"warnings": json.dumps(every), "doubts": json.dumps(rest)}


def doubts_of(attributes: Mapping[str, Any]) -> list[Doubt]:
    """Sentences that a dataset holds, with what they move where it says so."""
    texts = [str(text) for text in json.loads(attributes.get("warnings", "[]"))]
    if "doubts" not in attributes:
        return [*map(Doubt, texts)]
    return [
        Doubt(text, kind, extent, moves=part, about=tuple(about), brief="".join(brief))
        for text, (kind, extent, part, about, *brief) in zip(
            texts, json.loads(attributes["doubts"]), strict=True
        )
    ]


def worst_of_kinds(sentences: Iterable[str]) -> list[Doubt]:
    """Of each kind of sentences the one with the largest extent, in their order."""
    worst: dict[str, Doubt] = {}
    for doubt in map(as_doubt, sentences):
        if doubt.kind not in worst or doubt.extent > worst[doubt.kind].extent:
            worst[doubt.kind] = doubt
    return [*worst.values()]


def _merged(
    sentences: Iterable[str], numbered: re.Pattern[str], named: Callable[[str, list[str]], str]
) -> list[Doubt]:
    """Sentences that differ by one number alone as one that names all of them."""
    alike: dict[str, dict[str, Doubt]] = {}
    for doubt in map(as_doubt, sentences):
        numbers = {*numbered.findall(doubt)}
        number = numbers.pop() if len(numbers) == 1 else ""
        group = alike.setdefault(numbered.sub("#", doubt) if number else doubt, {})
        group[number] = max(group.get(number, doubt), doubt, key=moves)
    return [
        _alike(max(group.values(), key=moves), named(doubt, [*group]), named(doubt.brief, [*group]))
        for group in alike.values()
        for doubt in [next(iter(group.values()))]
    ]


def _stages(sentence: str, numbers: list[str]) -> str:
    """Sentence on the first of some stages, as one on all of them."""
    if len(numbers) == 1:
        return sentence
    stages, meshes = ([*dict.fromkeys(part)] for part in zip(*map(_parted, numbers), strict=True))
    if len(stages) * len(meshes) > len(numbers):
        stages, meshes = numbers, [""]
    named = "; ".join(filter(None, meshes))
    several = _STAGE.sub(f"{enumerated(stages)}{f' ({named})' if named else ''}", sentence)
    return several.replace("tage ", "tages ", 1) if len(stages) > 1 else several


def _parted(stage: str) -> tuple[str, str]:
    """Number of a stage, and its mesh in brackets where it has several."""
    number, _, mesh = stage.partition(" ")
    return number, mesh.strip("()")


def _gears(sentence: str, numbers: list[str]) -> str:
    """Sentence on the first of some gears, as one on all of them."""
    if len(numbers) == 1:
        return sentence
    alike = " and ".join(f"gear {number}" for number in numbers[1:])
    return _GEAR.sub(rf"\g<0> ({alike} alike)", sentence, count=1)
