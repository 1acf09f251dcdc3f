"""Share of the load that each pair of teeth carries, by named models."""

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import KINDS, TOUCH, Contacts, contact_velocity
from pitchpoint.core.programs import program
from pitchpoint.errors import InputError
from pitchpoint.gears.mesh import Mesh, has
from pitchpoint.gears.mesh_bodies import main_dimensions
from pitchpoint.gears.pairs import WAVE, touching, way_of_pairs
from pitchpoint.gears.tooth_section import tooth_sections
from pitchpoint.loading.compliance import Compliance
from pitchpoint.loading.equilibrium import equilibrium
from pitchpoint.loading.loading_registry import LOAD_SHARING, LoadSharing

__all__ = [
    "demand_sharing",
    "equal",
    "from_stiffness",
    "middle_of_path",
    "sanchez_2017",
    "sharing_applies",
    "single",
    "xu_2021_cosine",
    "zhao_2022_cosine",
]

Share = Float[Array, "pair slice *b"]

# Half angles of the zone in which pairs carry, as both papers have them.
_XU_END = jnp.pi / 8.0
_ZHAO_END = jnp.pi / 5.0


def sharing_applies(sharing: LoadSharing, mesh: Mesh) -> bool:
    """True if a model holds for a mesh."""
    return _limit(sharing, mesh) is None


def demand_sharing(sharing: LoadSharing, mesh: Mesh) -> None:
    """Raise InputError if a model does not hold for a mesh."""
    limit = _limit(sharing, mesh)
    if limit is None:
        return
    others = ", ".join(one.name for one in LOAD_SHARING.values() if sharing_applies(one, mesh))
    raise InputError(f"'{sharing.name}' {limit}; choose one of {others}")


def _limit(sharing: LoadSharing, mesh: Mesh) -> str | None:
    """What keeps a model from holding for a mesh, as the end of a sentence."""
    low, high = sharing.ratio_range
    if sharing.by_stiffness and not has(mesh, tooth_sections):
        return "needs teeth that yield, and this mesh has none"
    if sharing.shape not in (None, mesh.shape):
        return f"holds for {KINDS[sharing.shape]}, and these touch {TOUCH[mesh.shape]}"
    if sharing.flanks == "touching" and not touching(mesh):
        return "holds where all rigid flanks in mesh touch, and some of these have a gap"
    if sharing.flanks == "wave" and way_of_pairs(mesh) is not WAVE:
        return "holds for strain-wave gears, and these are not"
    if not sharing.straight and sharing.ratio_range == (0.0, float("inf")):
        return None
    whole, overlap = map(float, _ratios(mesh))
    if sharing.straight and overlap > 0.0:
        return "holds for spur gears, and these are helical"
    if not low < whole < high:
        return f"holds for contact ratios between {low:g} and {high:g}, this pair has {whole:.4g}"
    return None


@program
def _ratios(mesh: Mesh) -> tuple[Float[Array, ""], Float[Array, ""]]:
    return mesh.contact_ratio, jnp.asarray(main_dimensions(mesh).get("overlap_ratio", 0.0))


def equal(contacts: Contacts, mesh: Mesh, yielding: Compliance | None = None) -> Share:
    """Equal load per length of contact line in mesh.

    Args:
        contacts: of the mesh.
        mesh, yielding: not used, common to all models.

    From one load per length on all lines in mesh.
    """
    return _normalised(jnp.where(contacts.active, contacts.weight, 0.0))


def from_stiffness(contacts: Contacts, mesh: Mesh, yielding: Compliance | None) -> Share:
    """Load by stiffness: all slices yield by the same approach of the gears, less their clearance.

    Where all rigid flanks touch and no body couples the slices, load is in proportion to stiffness.

    Args:
        contacts: of the mesh.
        mesh: any family with teeth.
        yielding: how the pairs yield, and the load: pairs with a clearance come to carry with it.

    Returns:
        Shares; NaN where the equilibrium was not found.

    From the balance of springs side by side, see `equilibrium`.

    From springs side by side, which yield by one approach.
    """
    assert yielding is not None
    if yielding.body is None and touching(mesh):
        return _normalised(jnp.where(contacts.active, yielding.stiffness * contacts.weight, 0.0))
    return equilibrium(
        yielding.of_teeth(contacts),
        yielding.body,
        gap=yielding.gap(contacts),
        arm=jnp.abs(contact_velocity(contacts.normal, yielding.loaded)),
        active=contacts.active,
        load=yielding.load,
    ).share


def single(contacts: Contacts, mesh: Mesh, yielding: Compliance | None = None) -> Share:
    """Whole load on the pair nearest to the middle of the path of contact.

    Args:
        contacts: of the mesh.
        mesh: its contact ratio is the length of the path in base pitches.
        yielding: not used.
    """
    from_middle = jnp.abs(contacts.path - mesh.contact_ratio / 2.0)
    from_middle = jnp.where(contacts.active, from_middle, jnp.inf)
    nearest = from_middle <= jnp.min(from_middle, axis=0, keepdims=True)
    return _normalised(jnp.where(nearest & contacts.active, contacts.weight, 0.0))


def middle_of_path(ratio: Float[Array, ""]) -> Float[Array, " event"]:
    """Phase at which the pair nearest to the middle of the path changes.

    Args:
        ratio: length of the path in base pitches.
    """
    return jnp.mod((ratio + 1.0) / 2.0, 1.0)[None]


def sanchez_2017(contacts: Contacts, mesh: Mesh, yielding: Compliance | None = None) -> Share:
    """Linear form of the load sharing ratio of spur gears with Hertz stiffness, 1 < eps < 2.

    A pair carries 0.36 of the load at entry and exit, rising linearly to 0.64 next to the zone of
    single contact, where it carries all.

    Args:
        contacts: of the mesh, `path` in base pitches.
        mesh: its contact ratio is eps_alpha.
        yielding: not used.

    Source: Sanchez, Pleguezuelos, Pedrero (2017), in the form of Tian et al. (2024), eq. 11; within
    6 % of finite elements for pairs without profile modification.
    """
    double = mesh.contact_ratio - 1.0
    from_end = jnp.minimum(contacts.path, mesh.contact_ratio - contacts.path)
    share = jnp.where(from_end <= double, 0.36 + 0.28 * from_end / double, 1.0)
    return _normalised(jnp.where(contacts.active, share, 0.0))


def xu_2021_cosine(contacts: Contacts, mesh: Mesh, yielding: Compliance | None = None) -> Share:
    """Tooth force as cos(4 phi) within 22.5 degrees of the long axis, at both of its ends.

    Args:
        contacts: of a strain-wave gear, `path` the angle from the long axis [turns].
        mesh, yielding: not used.

    Source: Xu et al. (2021), eqs. 4 and 5. Their eq. 6 sums over teeth beyond the zone and over one
    end of the axis only; here the shares sum to one.
    """
    return _half_wave(contacts, _XU_END)


def zhao_2022_cosine(contacts: Contacts, mesh: Mesh, yielding: Compliance | None = None) -> Share:
    """Tooth force as cos(pi phi/72 deg) within 36 degrees of the long axis, at both of its ends.

    Args:
        contacts: of a strain-wave gear, `path` the angle from the long axis [turns].
        mesh, yielding: not used.

    Source: Zhao et al. (2022), eq. 13 with its peak on the long axis and their half angle of
    36 degrees, both sides of the axis alike as their torque, eq. 15, counts them.
    """
    return _half_wave(contacts, _ZHAO_END)


def _half_wave(contacts: Contacts, end: float) -> Share:
    angle = 2.0 * jnp.pi * contacts.path
    inside = contacts.active & (jnp.abs(angle) < end)
    force = jnp.cos(0.5 * jnp.pi * angle / end) * contacts.weight
    return _normalised(jnp.where(inside, force, 0.0))


def _normalised(share: Share) -> Share:
    return share / jnp.sum(share, axis=(0, 1), keepdims=True)
