"""What a case may choose by name of teeth under load: how they share it, and how they yield."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from pitchpoint.registry import Deferred, Registry

if TYPE_CHECKING:
    from jaxtyping import Array, Float

    from pitchpoint.contact.contacts import Contacts, Shape
    from pitchpoint.gears.mesh import Mesh
    from pitchpoint.loading.compliance import Compliance

__all__ = [
    "LINE_STIFFNESS",
    "LOAD_SHARING",
    "TOOTH_COMPLIANCE",
    "LineStiffness",
    "LoadSharing",
    "ToothCompliance",
]

Flanks = Literal["any", "touching", "wave"]


@dataclass(frozen=True, eq=False)
class LoadSharing:
    """One way of sharing the load.

    Attributes:
        name, title: by which it is picked, and what it says.
        function: share of each slice, summing to one, from contacts, mesh and how the pairs yield;
            None for models that do not ask for that.
        sources: keys of the bibliography.
        ratio_range: contact ratios for which it holds, exclusive.
        straight: True if it holds only for contact lines parallel to the axes.
        by_stiffness: True if the function asks how the pairs yield.
        shape: of contacts for which alone it holds; None for any.
        flanks: "touching" if it holds only where all rigid flanks in mesh touch, "wave" only for teeth
            that a wave presses into mesh, or "any".
        hand_over: phases, beside entry and exit, at which the share jumps or bends.
        note: caution for the user.
    """

    name: str
    title: str
    function: Deferred[
        Callable[[Contacts, Mesh, Compliance | None], Float[Array, "pair slice *b"]]
    ] = Deferred()
    sources: tuple[str, ...] = ()
    ratio_range: tuple[float, float] = (0.0, float("inf"))
    straight: bool = False
    by_stiffness: bool = False
    shape: Shape | None = None
    flanks: Flanks = "any"
    hand_over: Deferred[Callable[[Float[Array, ""]], Float[Array, " event"]] | None] = Deferred(
        None
    )
    note: str = ""


LOAD_SHARING = Registry(
    "load sharing model",
    LoadSharing(
        "sanchez_2017",
        "linear share of a spur pair, 0.36 - 0.64 - 1 - 0.64 - 0.36",
        "pitchpoint.loading.sharing:sanchez_2017",
        ("sanchez_2017", "tian_2024"),
        (1.0, 2.0),
        straight=True,
        shape="line",
        flanks="touching",
        note="Spur pairs of equal modulus without tip relief or deviation.",
    ),
    LoadSharing(
        "equal",
        "equal load per length of contact line",
        "pitchpoint.loading.sharing:equal",
        ("hohn_2010",),
        flanks="touching",
    ),
    LoadSharing(
        "from_stiffness",
        "load in proportion to the stiffness of the teeth along each contact line",
        "pitchpoint.loading.sharing:from_stiffness",
        ("weber_banaschek_1953",),
        by_stiffness=True,
        note="Thin slices side by side; `tooth_compliance` says how teeth yield.",
    ),
    LoadSharing(
        "single",
        "whole load on the pair nearest to the middle of the path",
        "pitchpoint.loading.sharing:single",
        (),
        straight=True,
        flanks="touching",
        hand_over="pitchpoint.loading.sharing:middle_of_path",
        note="A bound: what a pair would carry if its neighbours did not help.",
    ),
    LoadSharing(
        "xu_2021_cosine",
        "cosine over 22.5 degrees on both sides of the long axis",
        "pitchpoint.loading.sharing:xu_2021_cosine",
        ("xu_2021",),
        flanks="wave",
        note="A law for a strain-wave gear at its rated load: clearances and load do not enter.",
    ),
    LoadSharing(
        "zhao_2022_cosine",
        "cosine over 36 degrees on both sides of the long axis",
        "pitchpoint.loading.sharing:zhao_2022_cosine",
        ("zhao_2022",),
        flanks="wave",
        note="A law for a strain-wave gear at its rated load: clearances and load do not enter.",
    ),
)


@dataclass(frozen=True, eq=False)
class ToothCompliance:
    """One way of adding up how teeth yield.

    Attributes:
        name, title: by which it is picked, and what it says.
        foundation: True if the body under the tooth yields.
        contact: "linear" (Hertz, one compliance for every load) or "weber" (depends on the load).
        modulus: "separate" (each member its own) or "common" (2 E1 E2/(E1 + E2) for both).
        sources: keys of the bibliography.
        note: caution for the user.
    """

    name: str
    title: str
    foundation: bool
    contact: Literal["linear", "weber"]
    modulus: Literal["separate", "common"]
    sources: tuple[str, ...]
    note: str = ""


_BEAM = ("weber_banaschek_1953", "atanasiu_2011")


TOOTH_COMPLIANCE = Registry(
    "tooth compliance",
    ToothCompliance(
        "beam_foundation_weber",
        "beam on a yielding body, contact by Weber's law",
        foundation=True,
        contact="weber",
        modulus="separate",
        sources=(*_BEAM, "sainsot_2004", "johnson_1985"),
    ),
    ToothCompliance(
        "beam_foundation_hertz",
        "beam on a yielding body, linear contact",
        foundation=True,
        contact="linear",
        modulus="separate",
        sources=(*_BEAM, "sainsot_2004", "yang_sun_1985"),
    ),
    ToothCompliance(
        "beam_weber",
        "beam clamped at the root circle, contact by Weber's law",
        foundation=False,
        contact="weber",
        modulus="separate",
        sources=(*_BEAM, "johnson_1985"),
        note="Without the body under the tooth a pair comes out two to three times too stiff.",
    ),
    ToothCompliance(
        "beam_hertz",
        "beam clamped at the root circle, linear contact",
        foundation=False,
        contact="linear",
        modulus="separate",
        sources=(*_BEAM, "yang_sun_1985"),
        note="Without the body under the tooth a pair comes out two to three times too stiff.",
    ),
    ToothCompliance(
        "beam_hertz_common_modulus",
        "as beam_hertz, with 2 E1 E2/(E1 + E2) for both members",
        foundation=False,
        contact="linear",
        modulus="common",
        sources=(*_BEAM, "yang_sun_1985"),
        note="One modulus for both members is right only where both teeth yield alike.",
    ),
)


@dataclass(frozen=True, eq=False)
class LineStiffness:
    """One way from the stiffness of teeth at a point to that of a contact line.

    Attributes:
        name, title: by which it is picked, and what it says.
        sources: keys of the bibliography.
        note: caution for the user.
    """

    name: str
    title: str
    sources: tuple[str, ...]
    note: str = ""


LINE_STIFFNESS = Registry(
    "stiffness of a contact line",
    LineStiffness(
        "integrated",
        "stiffness of the teeth integrated along the contact line",
        ("atanasiu_2011",),
    ),
    LineStiffness(
        "middle",
        "stiffness of the teeth in the middle of the contact line, times its length",
        ("atanasiu_2011",),
        note="Some 3 % off for helical pairs of steel and plastic with few teeth, 8 % for a steel pair with "
        "long lines, 11 % where teeth are stiffest in the middle of their flank; the same for spur gears.",
    ),
)
