"""Registries of rival formulas: a name picks one, an unknown name gets the nearest known ones.

What a registry says of its entries is data. Code is loaded when it is chosen: it stands as its place,
"pitchpoint.loading.sharing:equal", the module and the name in it.
"""

import difflib
import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from importlib import import_module
from typing import Any, Generic, Protocol, TypeVar, overload

from pitchpoint.errors import InputError, shorten

__all__ = [
    "Deferred",
    "Registry",
    "code_at",
    "enumerated",
    "known_as",
    "letters",
    "listed",
    "nearest",
    "similar_names",
    "unknown_name",
]

_MOST = 24  # names in one sentence


class Named(Protocol):
    """Anything with a name."""

    @property
    def name(self) -> str:
        """Name by which it is picked."""
        ...


Entry = TypeVar("Entry", bound=Named)
Code = TypeVar("Code")
_NEEDED: Any = object()


class Deferred(Generic[Code]):
    """A field of a dataclass that is code: given as it is, or as its place, loaded when it is first used.

    Args:
        usual: what it is where nothing is given; without it the field has to be given.

    Example:
        >>> from collections.abc import Callable
        >>> from dataclasses import dataclass
        >>> @dataclass(frozen=True)
        ... class Law:
        ...     function: Deferred[Callable[[float], float]] = Deferred()
        >>> Law("math:sqrt").function(9.0), Law(abs).function(-9.0)
        (3.0, 9.0)
    """

    def __init__(self, usual: Code | str = _NEEDED) -> None:
        self._usual = usual

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, entry: None, owner: type) -> Any: ...
    @overload
    def __get__(self, entry: object, owner: type) -> Code: ...
    def __get__(self, entry: object | None, owner: type) -> Any:
        if entry is None:
            if self._usual is _NEEDED:
                raise AttributeError(self._name)  # by this a dataclass knows that it has no default
            return self._usual
        held = entry.__dict__[self._name]
        if isinstance(held, str):
            held = entry.__dict__[self._name] = code_at(held)
        return held

    def __set__(self, entry: object, given: Code | str) -> None:
        entry.__dict__[self._name] = given


def code_at(place: str) -> Any:
    """What stands at a place, "module:name"; only now it is loaded.

    Example:
        >>> code_at("math:sqrt")(9.0)
        3.0
    """
    module, _, name = place.partition(":")
    return getattr(import_module(module), name)


class Registry(Mapping[str, Entry]):
    """Entries by name, in the order in which they were given.

    Args:
        kind: names the entries in messages, e.g. "friction law".
        entries: with all that they say.
        places: by name those that are loaded when they are chosen, after the others.
    """

    def __init__(self, kind: str, *entries: Entry, places: Mapping[str, str] | None = None) -> None:
        self.kind = kind
        self._entries: dict[str, Entry | str] = {entry.name: entry for entry in entries}
        self._entries.update(places or {})

    def __getitem__(self, name: str) -> Entry:
        """Entry of that name, see `known_as`; InputError with the nearest names if there is none."""
        listed_name = known_as(name, self._entries)
        if listed_name is None:
            raise InputError(
                f"'{shorten(name)}' is not a known {self.kind}{nearest(name, self._entries)}"
            )
        entry = self._entries[listed_name]
        if isinstance(entry, str):
            entry = self._entries[listed_name] = code_at(entry)
        return entry

    def __contains__(self, name: object) -> bool:
        """True for the name of an entry."""
        return name in self._entries

    def __iter__(self) -> Iterator[str]:
        """Names in order."""
        return iter(self._entries)

    def __len__(self) -> int:
        """Number of entries."""
        return len(self._entries)

    def add(self, entry: Entry) -> None:
        """Add an entry at the end, or put it in the place of that of its name."""
        self._entries[entry.name] = entry


def known_as(name: str, known: Collection[str]) -> str | None:
    """The known name that a name means, whatever its case, spaces, hyphens and underscores.

    None if there is no such name, or more than one.

    Example:
        >>> known_as("PAO VG 150", ["pao-vg-150", "pao-vg-100"])
        'pao-vg-150'
    """
    if name in known:
        return name
    spelled_alike = (
        [entry for entry in known if letters(entry) == letters(name)] if letters(name) else []
    )
    return spelled_alike[0] if len(spelled_alike) == 1 else None


def nearest(name: str, known: Iterable[str]) -> str:
    """End of a sentence that offers the known names nearest to a wrong one, or all of them."""
    names = [*known]
    close = similar_names(name, names)
    if close:
        return f"; did you mean {' or '.join(close)}?"
    return f"; known are {listed(names)}" if names else "; there are none"


_GRADE = re.compile("[a-z]{1,3}[0-9]{2,4}")

_OTHERWISE = {
    **dict.fromkeys(("spur", "helical", "internal", "involute", "pair", "ring"), "cylindrical"),
    **dict.fromkeys(("rack", "rackpinion"), "rack_and_pinion"),
    **dict.fromkeys(("epicyclic", "planet", "planets", "planetaryset", "sun"), "planetary"),
    **dict.fromkeys(("stages", "gearbox", "drive", "twostage"), "two_stages"),
    **dict.fromkeys(("harmonic", "harmonicdrive", "strainwavegear"), "strain_wave"),
    **dict.fromkeys(("coulomb", "mu"), "constant"),
    **dict.fromkeys(("16mncr5", "20mncr5", "18crnimo76", "17crnimo6", "mq"), "case-hardened-mq"),
    **dict.fromkeys(("42crmo4", "34crnimo6", "c45"), "through-hardened-mq"),
    **dict.fromkeys(("oil", "oils", "lubricants", "grease"), "lubricant"),
    **dict.fromkeys(("steels", "plastics", "solid", "solids", "materials"), "material"),
    **dict.fromkeys(("pom", "delrin", "acetal"), "POM-H"),
    "nylon": "PA66",
}
"""What things are called elsewhere, by letters and figures; steels by their class in ISO 6336-5."""


def similar_names(name: str, known: Iterable[str], likeness: float = 0.6) -> list[str]:
    """At most three known names spelled like another, whatever its case, spaces and hyphens.

    A grade, "VG 220", is a part of up to six names, as is that at the end of a maker's name.

    Args:
        name: that was written.
        known: names that there are.
        likeness: least part of both names that has to agree; 1 for the same letters.

    Example:
        >>> similar_names("PAO VG 150", ["pao-vg-150", "pao-vg-100"])
        ['pao-vg-150']
        >>> similar_names("Shell Omala S2 150", ["pao-vg-150", "pao-vg-100"])
        ['pao-vg-150']
    """
    plain = {letters(spelling): spelling for spelling in known}
    wanted = letters(name)
    if (meant := _OTHERWISE.get(wanted)) in plain.values() and wanted not in plain:
        return [str(meant)]
    if wanted in plain:
        return [plain[wanted]]
    grade = wanted.removeprefix("iso")
    if _GRADE.fullmatch(grade) and (
        of_it := [plain[spelling] for spelling in plain if grade in spelling]
    ):
        return of_it[:6]
    near = [
        plain[spelling]
        for spelling in difflib.get_close_matches(wanted, plain, n=3, cutoff=likeness)
    ]
    viscosity = re.search("[0-9]{2,4}$", name.strip())
    if near or viscosity is None:
        return near
    return [name for spelling, name in plain.items() if spelling.endswith(f"vg{viscosity[0]}")][:6]


def unknown_name(name: str, allowed: Iterable[str], *, what: str) -> InputError:
    """Error for a name that is not in a list, with the nearest names it has.

    Args:
        name: the name that was asked for.
        allowed: the names that exist.
        what: what the name stands for, with its article: "a lubricant".

    Example:
        >>> str(unknown_name("stel", ["steel", "pom"], what="a material"))
        '"stel" is not a material in the catalogue; did you mean steel?'
    """
    names = sorted(allowed)
    sentence = f'"{shorten(name)}" is not {what} in the catalogue{nearest(name, names)}'
    return InputError(sentence, value=name, allowed=names)


def listed(names: Iterable[str]) -> str:
    """Names in a sentence, of very many the first ones."""
    every = [*names]
    remainder = f" and {len(every) - _MOST} more" if len(every) > _MOST else ""
    return ", ".join(map(shorten, every[:_MOST])) + remainder


def enumerated(names: Iterable[object]) -> str:
    """All names in a sentence, at least one.

    Example:
        >>> enumerated([1]), enumerated([1, 2, 3])
        ('1', '1, 2 and 3')
    """
    *beginning, ending = map(str, names)
    return " and ".join(filter(None, [", ".join(beginning), ending]))


def letters(name: str) -> str:
    """Letters and digits of a name in lower case."""
    return re.sub(r"[\W_]", "", name.casefold())
