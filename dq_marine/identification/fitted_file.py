"""The vehicle found, as a file that loads again and says where its numbers come from."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from dq_marine.identification.fit import Fit
from dq_marine.identification.problem import OUTPUTS
from dq_marine.util.files import check_ending, check_folder, check_targets, write_whole
from dq_marine.util.toml_text import toml_text


def check_vehicle_path(path: Path, *, force: bool) -> None:
    """Check that a vehicle file can be written to a path.

    Raises:
        InvalidInputError: its ending is not .toml, its folder does not exist, or it is there and shall not be replaced.
    """
    check_ending(path, ".toml")
    check_folder(path)
    check_targets([path], force=force)


def write_fitted(fit: Fit, path: Path) -> None:
    """Write the vehicle found, with what it was found from as comments and among its sources.

    Raises:
        InvalidInputError: the file cannot be written.
    """
    content: dict[str, Any] = fit.vehicle.model_dump(mode="json", exclude_defaults=True)
    content["name"] = f"{fit.nominal.name} (fitted)"
    content["sources"] = [_source(fit), *fit.nominal.sources]
    content["added_mass"] = _shortened(content["added_mass"])
    content["damping"]["linear"] = _shortened(content["damping"]["linear"])
    write_whole(path, "\n".join([*_comments(fit), "", toml_text(content)]))


def _source(fit: Fit) -> str:
    names = ", ".join(estimate.label for estimate in fit.estimates)
    return (
        f"Identified with dq-marine vehicles fit from {fit.log!r}, {fit.duration:.4g} s in {fit.segments} "
        f"segments: {names}. All else is that of {fit.nominal.name!r}, whose sources follow."
    )


def _comments(fit: Fit) -> list[str]:
    origin = f"{fit.log}: {fit.duration:.6g} s of motion, cut into {fit.segments} segments"
    lines = [f"{fit.nominal.name}, its numbers identified from {origin}.", ""]
    lines.append("found, with standard errors (before):")
    for one in fit.estimates:
        share = 100.0 * abs(one.standard_error / one.value) if one.value else np.inf
        lines.append(
            f"  {one.label}: {one.value:.6g} +- {one.standard_error:.2g} {one.unit}, {share:.2g} % ({one.nominal:.6g})"
        )
    if fit.held:
        lines += ["", "not told by the log, and held:"]
        lines += [f"  {label}" for label, _ in fit.held]
    lines += ["", "root of the mean square of the residuals:"]
    lines += [
        f"  {name}: {noise:.4g} {unit}"
        for (name, unit), noise in zip(OUTPUTS, fit.noise, strict=True)
        if noise == noise
    ]
    return [f"# {_printable(line)}".rstrip() for line in [*lines, "", *fit.notes]]


def _printable(line: str) -> str:
    return "".join(character if character.isprintable() else "?" for character in line)


def _shortened(matrix: list[list[float]]) -> list[Any]:
    """Return a diagonal matrix as its diagonal."""
    values = np.array(matrix)
    diagonal = np.diag(values)
    return diagonal.tolist() if (values == np.diag(diagonal)).all() else matrix
