"""Bodies of the cases that are no vehicle files: masses and restoring of published vehicles, in Fossen's order."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dq_marine.physics.constants import GRAVITY
from dq_marine.physics.matrices import skew

Array = NDArray[np.float64]


def rigid_body(mass: float, center: Array, inertia: Array) -> Array:
    """Return M_RB of a mass [kg] at a centre [m] with an inertia about the origin [kg m^2] (Fossen 2021, ch. 3)."""
    s = mass * skew(center)
    return np.block([[mass * np.eye(3), -s], [s, inertia]])


def remus_100() -> Array:
    """Return M of the REMUS 100, a torpedo of 30.5 kg, with its coupled added mass.

    Prestero, T. (2001). Verification of a Six-Degree of Freedom Simulation Model for the REMUS Autonomous Underwater
    Vehicle. M.Sc. thesis, MIT/WHOI: inertia and coefficients of added mass.
    """
    dry = rigid_body(30.48, np.array([0.0, 0.0, 0.0196]), np.diag([0.177, 3.45, 3.45]))
    added = np.diag([0.930, 35.5, 35.5, 0.0704, 4.88, 4.88])
    added[1, 5] = added[5, 1] = -1.93  # -Y_rdot = -N_vdot
    added[2, 4] = added[4, 2] = 1.93  # -Z_qdot = -M_wdot
    return np.asarray(dry + added)


@dataclass(frozen=True)
class Rexrov:
    """The RexROV, a work-class ROV of 1.9 t with a full added mass matrix, made neutrally buoyant.

    Berg, V. (2012). Development and Commissioning of a DP system for ROV SF 30k. M.Sc. thesis, NTNU, pp. 28-31, as used
    by the UUV Simulator (Manhaes et al. 2016, OCEANS), whose body frame has z up: the products of inertia are turned
    here. The matrix of added mass is symmetric but for one last digit, and made so.

    Attributes:
        mass: [kg].
        buoyancy_height: of the centre of buoyancy above that of mass, as the UUV Simulator has it [m].
    """

    mass: float = 1862.87
    buoyancy_height: float = 0.3

    @property
    def mass_matrix(self) -> Array:
        """M."""
        inertia = np.array([[525.39, -1.44, -33.41], [-1.44, 794.20, 2.6], [-33.41, 2.6, 691.23]])
        added = np.array(
            [
                [779.79, -6.8773, -103.32, 8.5426, -165.54, -7.8033],
                [-6.8773, 1222.0, 51.29, 409.44, -5.8488, 62.726],
                [-103.32, 51.29, 3659.9, 6.1112, -386.42, 10.774],
                [8.5426, 409.44, 6.1112, 534.9, -10.027, 21.019],
                [-165.54, -5.8488, -386.42, -10.027, 842.69, -1.1162],
                [-7.8033, 62.726, 10.775, 21.019, -1.1162, 224.32],
            ]
        )
        return np.asarray(rigid_body(self.mass, np.zeros(3), inertia) + 0.5 * (added + added.T))

    @property
    def arm(self) -> Array:
        """W r_G - B r_B [N m]."""
        return np.array([0.0, 0.0, self.mass * GRAVITY * self.buoyancy_height])


def supply_vessel() -> Array:
    """Return M of a supply vessel of 83 m and 6,360 t about the waterline, added mass that of high frequencies.

    Marine Systems Simulator, T. I. Fossen and T. Perez (MIT licence), HYDRO/vessels_shipx/supply, computed by ShipX.
    Its added mass is slightly asymmetric and made symmetric here. `SUPPLY_VESSEL_RESTORING` is from the same source.
    """
    mass, center = 6362208.5, np.array([-5.3859196, 0.0, -1.3])
    inertia = np.array(
        [
            [298059260.0, 0.0, -44546243.535],
            [0.0, 2921450770.9, 0.0],
            [-44546243.535, 0.0, 2910698770.9],
        ]
    )
    added = np.diag([656165.0, 2184175.0, 11228956.0, 69095858.0, 4900391210.0, 1139690489.0])
    added[1, 3] = added[3, 1] = 0.5 * (3494043.0 + 3067235.0)
    added[1, 5] = added[5, 1] = -0.5 * (10411331.0 + 10761648.0)
    added[2, 4] = added[4, 2] = 0.5 * (109536986.0 + 107304982.0)
    added[3, 5] = added[5, 3] = -0.5 * (98023210.0 + 80287774.0)
    return rigid_body(mass, center, inertia) + added


SUPPLY_VESSEL_RESTORING = (13910359.0, 133797350.0, 7633174295.0, 145649203.0)
"""Z_z [N/m], K_phi [N m], M_theta [N m] and Z_theta [N] of the supply vessel."""
