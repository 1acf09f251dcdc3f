"""Share of the load that each pair of teeth carries, by named models."""

from collections.abc import Callable
from dataclasses import dataclass

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.errors import InputError
from pitchpoint.gears.mesh import Mesh
from pitchpoint.registry import Registry

__all__ = ["LOAD_SHARING", "LoadSharing", "equal", "from_stiffness", "sanchez_2017", "single"]

Ratio = Float[Array, ""]
Share = Float[Array, "pair slice *b"]
Stiffness = Float[Array, "pair slice *b"] | None


@dataclass(frozen=True, eq=False)
class LoadSharing:
    """One way of sharing the load.

    Attributes:
        name, title: by which it is picked, and what it says.
        function: share of each slice from contacts, contact ratio and stiffness of the pairs per
            length of contact line [N/m2], or None for models that do not ask for it.
        sources: keys of the bibliography.
        ratio_range: contact ratios for which it holds, exclusive.
        straight: True if it holds only for contact lines parallel to the axes.
        by_stiffness: True if the function needs the stiffness.
        hand_over: phases, beside entry and exit, at which the share jumps or bends.
        note: caution for the user.
    """

    name: str
    title: str
    function: Callable[[Contacts, Ratio, Stiffness], Share]
    sources: tuple[str, ...]
    ratio_range: tuple[float, float] = (0.0, float("inf"))
    straight: bool = False
    by_stiffness: bool = False
    hand_over: Callable[[Ratio], Float[Array, " event"]] | None = None
    note: str = ""

    def applies(self, mesh: Mesh) -> bool:
        """True if the model holds for this mesh."""
        low, high = self.ratio_range
        anywhere = (low, high) == (0.0, float("inf"))
        return (
            (mesh.toothed or not self.by_stiffness)
            and not (self.straight and float(mesh.overlap_ratio) > 0.0)
            and (anywhere or low < float(mesh.contact_ratio) < high)
        )

    def check(self, mesh: Mesh) -> None:
        """Raise InputError if the model does not hold for this mesh."""
        if self.applies(mesh):
            return
        others = ", ".join(entry.name for entry in LOAD_SHARING.values() if entry.applies(mesh))
        low, high = self.ratio_range
        if self.by_stiffness:
            limit = "needs teeth that yield, and this mesh has none"
        elif self.straight and float(mesh.overlap_ratio) > 0.0:
            limit = "holds for spur gears, and these are helical"
        else:
            limit = (
                f"holds for contact ratios between {low:g} and {high:g}, this pair has "
                f"{float(mesh.contact_ratio):.4g}"
            )
        raise InputError(f"'{self.name}' {limit}; choose one of {others}")


def equal(contacts: Contacts, contact_ratio: Ratio, stiffness: Stiffness = None) -> Share:
    """Equal load per length of contact line in mesh.

    Args:
        contacts: of the mesh.
        contact_ratio, stiffness: not used, common to all models.
    """
    return _normalised(jnp.where(contacts.active, contacts.weight, 0.0))


def from_stiffness(contacts: Contacts, contact_ratio: Ratio, stiffness: Stiffness) -> Share:
    """Load in proportion to stiffness: all slices yield by the same approach of the two gears.

    Args:
        contacts: of the mesh, whose unloaded flanks touch everywhere.
        contact_ratio: not used, common to all models.
        stiffness: of each slice per length of contact line [N/m2].
    """
    assert stiffness is not None
    return _normalised(jnp.where(contacts.active, stiffness * contacts.weight, 0.0))


def single(contacts: Contacts, contact_ratio: Ratio, stiffness: Stiffness = None) -> Share:
    """Whole load on the pair nearest to the middle of the path of contact.

    Args:
        contacts: of the mesh.
        contact_ratio: eps_alpha, length of the path in base pitches.
        stiffness: not used.
    """
    from_middle = jnp.where(contacts.active, jnp.abs(contacts.path - contact_ratio / 2.0), jnp.inf)
    nearest = from_middle <= jnp.min(from_middle, axis=0, keepdims=True)
    return _normalised(jnp.where(nearest & contacts.active, contacts.weight, 0.0))


def sanchez_2017(contacts: Contacts, contact_ratio: Ratio, stiffness: Stiffness = None) -> Share:
    """Linear form of the load sharing ratio of spur gears with Hertz stiffness, 1 < eps < 2.

    A pair carries 0.36 of the load at entry and exit, rising linearly to 0.64 next to the zone of
    single contact, where it carries all.

    Args:
        contacts: of the mesh, `path` in base pitches.
        contact_ratio: eps_alpha.
        stiffness: not used.

    Source: Sanchez, Pleguezuelos, Pedrero (2017), in the form of Tian et al. (2024), eq. 11; within
    6 % of finite elements for pairs without profile modification.
    """
    double = contact_ratio - 1.0
    from_end = jnp.minimum(contacts.path, contact_ratio - contacts.path)
    share = jnp.where(from_end <= double, 0.36 + 0.28 * from_end / double, 1.0)
    return _normalised(jnp.where(contacts.active, share, 0.0))


def _normalised(share: Share) -> Share:
    return share / jnp.sum(share, axis=(0, 1), keepdims=True)


LOAD_SHARING = Registry(
    "load sharing model",
    LoadSharing(
        "sanchez_2017",
        "linear share of a spur pair, 0.36 - 0.64 - 1 - 0.64 - 0.36",
        sanchez_2017,
        ("sanchez_2017", "tian_2024"),
        (1.0, 2.0),
        straight=True,
        note="Spur pairs of equal modulus without tip relief or deviation.",
    ),
    LoadSharing("equal", "equal load per length of contact line", equal, ("hohn_2010",)),
    LoadSharing(
        "from_stiffness",
        "load in proportion to the stiffness of the teeth along each contact line",
        from_stiffness,
        ("weber_banaschek_1953",),
        by_stiffness=True,
        note="Thin slices side by side, gears without deviations; `tooth_compliance` says how teeth yield.",
    ),
    LoadSharing(
        "single",
        "whole load on the pair nearest to the middle of the path",
        single,
        (),
        straight=True,
        hand_over=lambda ratio: jnp.mod((ratio + 1.0) / 2.0, 1.0)[None],
        note="A bound: what a pair would carry if its neighbours did not help.",
    ),
)
