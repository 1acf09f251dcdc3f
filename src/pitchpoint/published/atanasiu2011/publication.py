"""What Atanasiu et al. (2011) print beside what the library computes, as quantities of a result."""

from pitchpoint.published.publication import Publication
from pitchpoint.results.variable import Variable

__all__ = ["PUBLICATION"]

_VARIABLES = {
    "printed_undercut_limit_1": Variable(
        "smallest profile shift of gear 1, formula as printed", "x_min1", "1"
    ),
    "printed_equivalent_mass": Variable(
        "equivalent mass, formula as printed", "m_e", "kg", "g", "mass"
    ),
}

PUBLICATION = Publication(
    name="atanasiu_2011",
    readings=("pitchpoint.published.atanasiu2011.printed:readings",),
    variables=_VARIABLES,
)
