"""A fit's numbers for the terminal, and as a dictionary."""

from __future__ import annotations

import math
from typing import Any

from rich.table import Table
from rich.text import Text

from dq_marine.identification.fit import Fit
from dq_marine.identification.problem import OUTPUTS


def fit_table(fit: Fit) -> Table:
    """Return all parameters: what is in the file, what was found, and how sure that is."""
    caption = f"{fit.log}: {fit.duration:.4g} s in {fit.segments} segments. Error: one standard error."
    table = Table(title=Text(f"{fit.nominal.name}, fitted"), caption=Text(caption))
    table.add_column("parameter")
    for heading in ("file", "found", "error", "error %"):
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("unit", no_wrap=True)
    for one in fit.estimates:
        share = 100.0 * abs(one.standard_error / one.value) if one.value else math.inf
        numbers = (f"{one.nominal:.4g}", f"{one.value:.4g}", f"{one.standard_error:.2g}", f"{share:.2g}")
        table.add_row(Text(one.label), *numbers, Text(one.unit))
    for label, _ in fit.held:
        table.add_row(Text(label), "", "held", "", "", "", style="yellow")
    return table


def as_dict(fit: Fit) -> dict[str, Any]:
    """Return a fit as text, lists and numbers, with None for what is infinite."""
    return {
        "vehicle": fit.nominal.name,
        "log": fit.log,
        "duration_s": fit.duration,
        "segments": fit.segments,
        "estimates": [
            {
                "label": one.label,
                "unit": one.unit,
                "file": one.nominal,
                "found": one.value,
                "standard_error": one.standard_error,
            }
            for one in fit.estimates
        ],
        "held": [
            {"label": label, "relative_standard_error": error if math.isfinite(error) else None}
            for label, error in fit.held
        ],
        "residual_rms": {
            name: {"value": float(noise), "unit": unit}
            for (name, unit), noise in zip(OUTPUTS, fit.noise, strict=True)
            if not math.isnan(noise)
        },
        "notes": list(fit.notes),
    }
