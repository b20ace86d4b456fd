"""The command `dq-marine vehicles from-mesh`."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from dq_marine.cli.common import console, error_console
from dq_marine.cli.keyword_values import read_value

if TYPE_CHECKING:
    from dq_marine.meshes.building import BuiltVehicle
    from dq_marine.meshes.potential_flow import Progress

EXAMPLES = (
    "dq-marine vehicles from-mesh auv.stl --mass 31 --unit mm",
    "dq-marine vehicles from-mesh rov.stl my_rov.toml --mass 11.5 --shape open_frame --center-of-mass 0,0,0.02",
    "dq-marine vehicles from-mesh barge.stl --draft 0.4 --radiation",
    "dq-marine vehicles from-mesh boat.stl --mass 900 --afloat --axes fsd --limits 2000,0,0,0,0,1500",
    "dq-marine vehicles sheet my_auv.toml",
)


def from_mesh(
    mesh: Annotated[
        Path, typer.Argument(help="An STL file, binary or ASCII: the closed outer surface of the hull.")
    ],
    file: Annotated[
        Path | None, typer.Argument(help="File to write, ending in .toml.", show_default="my_MESH.toml")
    ] = None,
    mass: Annotated[
        float | None, typer.Option("--mass", help="kg. Left out: the mass of the water displaced.")
    ] = None,
    draft: Annotated[
        float | None,
        typer.Option("--draft", help="It floats, its keel so many metres deep; the mass follows."),
    ] = None,
    afloat: Annotated[
        bool, typer.Option("--afloat", help="It floats; the draft follows from --mass.")
    ] = False,
    unit: Annotated[str, typer.Option("--unit", help="Of the mesh: m, cm, mm, in or ft.")] = "m",
    axes: Annotated[
        str, typer.Option("--axes", help="Of the mesh: flu (x forward, y to port, z up) or fsd (body frame).")
    ] = "flu",
    origin: Annotated[
        str,
        typer.Option(
            "--origin",
            help="Body origin: center (of buoyancy; afloat, amidships in the waterline) or mesh (the file's own).",
        ),
    ] = "center",
    center_of_mass: Annotated[
        str | None,
        typer.Option("--center-of-mass", help="x,y,z from the body origin in m: forward, starboard, down."),
    ] = None,
    inertia: Annotated[
        str | None,
        typer.Option(
            "--inertia", help="Ix,Iy,Iz about the centre of mass in kg m^2. Left out: a uniform filling's."
        ),
    ] = None,
    water_density: Annotated[
        float | None,
        typer.Option("--water-density", help="kg/m^3. Left out: 1000 under water, 1025 afloat."),
    ] = None,
    speed: Annotated[
        float | None,
        typer.Option(
            "--speed",
            help="Speed that damping is estimated for, in m/s. Left out: 1.5, afloat 0.2 sqrt(g L).",
        ),
    ] = None,
    shape: Annotated[
        str | None,
        typer.Option(
            "--shape",
            help="open_frame, torpedo, ellipsoid, catamaran or ship, for drag and drawing. Left out: guessed.",
        ),
    ] = None,
    limits: Annotated[
        str | None,
        typer.Option(
            "--limits", help="Largest force and moment, six numbers in N and N m. Left out: from the drag."
        ),
    ] = None,
    radiation: Annotated[
        bool, typer.Option("--radiation", help="Solve added mass and damping by frequency, too (afloat).")
    ] = False,
    frequencies: Annotated[
        int, typer.Option("--frequencies", min=1, help="How many, with --radiation.")
    ] = 16,
    panels: Annotated[
        int,
        typer.Option(
            "--panels", help="At least so many: 1500 take seconds, 5000 minutes for each frequency."
        ),
    ] = 1500,
    name: Annotated[str | None, typer.Option("--name", help="Of the vehicle. Left out: the file's.")] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace existing files.")] = False,
) -> None:
    """Make a vehicle from a mesh of its hull, as a complete vehicle file.

    Volume, centre of buoyancy and the stiffness of a hull afloat are integrals over the mesh.
    Added mass, with all its couplings, is solved for by the panel method Capytaine (the extra bem): in unbounded water,
    or at infinite frequency under a free surface. Damping, and what you leave out, is estimated; each number says how,
    in a comment beside it. Triangles are cut until there are enough panels; turned ones are turned back.
    """
    from dq_marine.meshes import Choices, vehicle_from_mesh

    choices = Choices(
        mass=mass,
        draft=draft,
        afloat=afloat,
        unit=unit,
        axes=axes,
        origin=origin,
        center_of_mass=_given("--center-of-mass", center_of_mass),
        inertia=_given("--inertia", inertia),
        water_density=water_density,
        speed=speed,
        shape=shape,
        limits=_given("--limits", limits),
        panels=panels,
        frequencies=frequencies if radiation else 0,
        name=name,
    )
    target = Path(f"my_{mesh.stem}.toml") if file is None else file
    with _shown_progress() as progress:
        built, files = vehicle_from_mesh(mesh, target, choices, force=force, progress=progress)
    for line in _summary(built):
        console.print(line, soft_wrap=True, highlight=False, markup=False)
    for written in files:
        console.print(f"Wrote {written}", soft_wrap=True, highlight=False, markup=False)
    console.print(f"Next: dq-marine vehicles check {target}", soft_wrap=True, highlight=False, markup=False)


def _given(option: str, text: str | None) -> Any:
    return None if text is None else read_value(text, option=option)


def _summary(built: BuiltVehicle) -> Iterator[str]:
    """Yield what to compare with what one knows of the vehicle, above all the unit and the axes."""
    hull = built.hull
    length, width, height = hull.surface.extent
    yield (
        f"Hull of {length:.4g} x {width:.4g} x {height:.4g} m (length, width, height), "
        f"displacing {hull.volume:.5g} m^3; {hull.mass:.5g} kg"
    )
    if hull.turned:
        yield f"{hull.turned} of {len(hull.surface.triangles)} triangles were turned, so that the outside is out"
    if hull.draft is not None:
        yield f"It floats at a draft of {hull.draft:.4g} m"
    ratios = built.vehicle.added_mass_matrix.diagonal()[:3] / hull.mass
    yield f"Added mass over mass, by {built.panels} panels: " + ", ".join(
        f"{motion} {ratio:.3g}" for motion, ratio in zip(("surge", "sway", "heave"), ratios, strict=True)
    )


@contextmanager
def _shown_progress() -> Iterator[Progress]:
    """Show on standard error how far the solver is."""
    from rich.progress import Progress as Bars
    from rich.progress import TaskID

    bars = Bars(console=error_console, transient=True)
    tasks: dict[str, TaskID] = {}

    def show(what: str, done: int, total: int) -> None:
        if what not in tasks:
            bars.start()  # not before: bars leave a line behind, and a refused mesh has none
            tasks[what] = bars.add_task(f"Solving for {what}", total=total)
        bars.update(tasks[what], completed=done)

    try:
        yield show
    finally:
        if tasks:
            bars.stop()
