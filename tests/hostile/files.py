"""Doors of files that a vehicle is made or judged by: meshes, logs of motion, and trials to be held against."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from support.solids import box, ellipsoid, write_ascii_stl, write_stl

import dq_marine.validation
from dq_marine.envs.scenarios.files import FOLDER as SCENARIOS
from dq_marine.envs.scenarios.files import read_scenarios
from dq_marine.identification import read_log
from dq_marine.meshes import Choices, vehicle_from_mesh
from dq_marine.validation import load_references
from dq_marine.vehicles import load_vehicle
from hostile.texts import changed_bytes, changed_table, changed_text
from hostile.values import Rng, hostile

CHOICES = {
    "mass": (3.0, 12.0),
    "draft": (0.05, 0.1),
    "afloat": (True,),
    "unit": ("mm", "ft"),
    "axes": ("fsd",),
    "origin": ("mesh",),
    "center_of_mass": ((0.0, 0.0, 0.02),),
    "inertia": ((0.2, 0.3, 0.3),),
    "water_density": (1025.0,),
    "speed": (2.0,),
    "shape": ("torpedo", "ship"),
    "limits": ((40.0, 40.0, 40.0, 5.0, 5.0, 5.0),),
    "frequencies": (2,),
    "gravity": (9.8,),
    "name": ("mine",),
}
"""What a vehicle from a mesh may be made with, besides panels: as few as may be, or a case would take long."""

REFERENCES = Path(dq_marine.validation.__file__).parent / "references"

COLUMNS = (
    *("time_s", "depth_m", "roll_deg", "pitch_deg", "heading_deg"),
    *("u_m_s", "v_m_s", "w_m_s", "p_rad_s", "q_rad_s", "r_rad_s"),
    *("X_N", "Y_N", "Z_N", "K_N_m", "M_N_m", "N_N_m"),
)


def with_file(name: str, content: bytes, use: Callable[[Path], Any]) -> Callable[[], Any]:
    """Write a file into a folder of its own; return what uses it and removes both."""
    folder = tempfile.TemporaryDirectory()
    file = Path(folder.name) / name
    file.write_bytes(content)

    def go() -> Any:
        with folder:
            return use(file)

    return go


def drawn_mesh_file(rng: Rng) -> Callable[[], Any]:
    """A small mesh, gone wrong or not, and choices of which some are wrong."""
    with tempfile.TemporaryDirectory() as folder:
        solid = (box(0.4, 0.3, 0.2), ellipsoid(0.5, 0.1, 0.1, splits=1))[rng.integers(2)]
        write = (write_stl, write_ascii_stl)[rng.integers(2)]
        content = write(Path(folder) / "hull.stl", solid).read_bytes()
    for _ in range(rng.integers(3)):
        content = changed_bytes(rng, content)
    chosen: dict[str, Any] = {}
    for name, values in CHOICES.items():
        if not rng.integers(8):
            chosen[name] = hostile(rng) if rng.integers(2) else values[rng.integers(len(values))]

    def make(file: Path) -> Any:
        return vehicle_from_mesh(file, file.with_name("made.toml"), Choices(**chosen, panels=100))

    return with_file("hull.stl", content, make)


def drawn_log_file(rng: Rng) -> Callable[[], Any]:
    """Logged motion, gone wrong or not."""
    lines = [",".join(COLUMNS)]
    for k in range(120):
        row = [0.1 * k, 5.0, 1.0, 2.0, 90.0, *rng.normal(0.3, 0.01, 6), *rng.normal(0.0, 5.0, 6)]
        lines.append(",".join(f"{number:.6g}" for number in row))
    text = "\n".join(lines)
    for _ in range(rng.integers(3)):
        text = changed_table(rng, text)
    vehicle = load_vehicle(("bluerov2_heavy", "otter")[rng.integers(2)])
    content = text.encode("utf-8", errors="surrogatepass")
    return with_file("log.csv", content, lambda file: read_log(file, vehicle))


def drawn_scenario_file(rng: Rng) -> Callable[[], Any]:
    """Scenarios of a task, their text gone wrong or not."""
    files = sorted(SCENARIOS.glob("*.toml"))
    text = files[rng.integers(len(files))].read_text(encoding="utf-8")
    for _ in range(rng.integers(4)):
        text = changed_text(rng, text)
    content = text.encode("utf-8", errors="surrogatepass")
    return with_file("scenarios.toml", content, read_scenarios)


def drawn_reference_file(rng: Rng) -> Callable[[], Any]:
    """Trials that a vehicle is held against, their text gone wrong or not."""
    files = sorted(REFERENCES.glob("*.toml"))
    text = files[rng.integers(len(files))].read_text(encoding="utf-8")
    for _ in range(rng.integers(4)):
        text = changed_text(rng, text)
    content = text.encode("utf-8", errors="surrogatepass")
    return with_file("trials.toml", content, lambda file: load_references(file))
