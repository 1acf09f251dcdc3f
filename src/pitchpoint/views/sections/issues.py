"""Issues of a publication, and what each variant says."""

from collections.abc import Iterator
from typing import Any

from pitchpoint.analyses.main_figures import MAIN
from pitchpoint.views import section, show
from pitchpoint.views.figures import laws
from pitchpoint.views.sections.back_driving import back_driving
from pitchpoint.views.sections.spread import spread

__all__ = ["ISSUES"]

_SIDE_BY_SIDE = (
    *MAIN,
    "loss_factor",
    "contact_ratio",
    "mean_stiffness",
    "stiffness_variation",
    "mean_transmission_error",
    "transmission_error_range",
    "largest_dynamic_factor",
)
_STEADY = ("mean_transmission_error", "transmission_error_range", "largest_dynamic_factor")


def _blocks(page: section.Page) -> Iterator[section.Block]:
    issues = page.first["issues"]
    if page.several:
        if issues:
            yield section.Heading("What each variant says")
        yield _side_by_side(page)
    if issues:
        yield section.Heading("Issues and verdicts")
        yield section.Drawn("issues.html.jinja", {"issues": issues})


def _side_by_side(page: section.Page) -> section.SectionTable:
    """Main figures of all variants and laws in one table, with the spread of the laws."""
    columns = [
        (variant, outcome, position, law)
        for variant, outcome in page.having("operation").items()
        for position, law in enumerate(laws(outcome.parts["operation"]))
    ]
    lines = [
        (
            show.axis_title(name, columns[0][1].parts["operation"]),
            *(_told(design.parts["operation"], name, k) for _, design, k, _ in columns),
        )
        for name in _SIDE_BY_SIDE
        if any(name in design.parts["operation"] for _, design, *_ in columns)
    ]
    within = [(spread(design) or {"text": "not computed"})["text"] for _, design, *_ in columns]
    back = [back_driving(design, law) for _, design, _, law in columns]
    return section.SectionTable(
        [
            "At the operating point",
            *(page.curves[variant, law].label for variant, _, _, law in columns),
        ],
        [
            *lines,
            ("mean efficiency by the friction laws that apply", *within),
            ("back-driving", *back),
        ],
    )


def _told(data: Any, name: str, law: int) -> str:
    """A figure at the operating point; one of a vibration only if there is a steady state."""
    if name not in data:
        return "not computed"
    if name in _STEADY and "vibration_status" in data and data["vibration_status"].values[law, 0]:
        return "none"
    return show.quantity(name, float(data[name].values[law, 0]), with_unit=False, of=data)


def _titled(page: section.Page) -> str:
    return "Issues of the publication" if page.first["issues"] else "Variants side by side"


ISSUES = section.Section(
    name="issues",
    title=_titled,
    short=lambda page: "Issues" if page.first["issues"] else "Variants",
    order=810.0,
    lacks=lambda page: None if page.several or page.first["issues"] else "",
    blocks=_blocks,
)
