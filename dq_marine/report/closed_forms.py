"""Motions with a closed form, in Jacobi's elliptic functions: the free top, and the spheroid that turns broadside.

Sources: L. D. Landau, E. M. Lifshitz, Mechanics, 3rd ed., sec. 37 (the asymmetrical top); H. Lamb, Hydrodynamics,
6th ed., sec. 127 (planar motion of a body in water). Functions from SciPy, parameter m = k^2 throughout.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.report.end_state import EndState
from dq_marine.util.extras import extra_needed

Array = NDArray[np.float64]


def special() -> Any:
    """Return SciPy's special functions."""
    with extra_needed("a closed form", "report"):
        import scipy.special

    return scipy.special


@dataclass(frozen=True)
class FreeTop:
    """A body that turns freely about its centre of mass, with isotropic mass, so that its centre moves straight on.

    Attributes:
        moments: principal moments of inertia about the body axes [kg m^2], the second between the others.
        quaternion: at the start, body to NED.
        position: of the centre at the start [m].
        velocity: at the start, Fossen's order, shape (6,).
    """

    moments: tuple[float, float, float]
    quaternion: tuple[float, float, float, float]
    position: tuple[float, float, float]
    velocity: tuple[float, ...]

    def __call__(self, time: float) -> EndState:
        """Return where the body is at a time [s]."""
        start = quaternion_matrix(np.array(self.quaternion))
        velocity_ned = start @ np.array(self.velocity[:3])
        turned, spin = self._turned(time)
        rotation = start @ turned
        position = np.array(self.position) + time * velocity_ned
        velocity = np.concatenate([rotation.T @ velocity_ned, spin])
        return EndState(position, matrix_quaternion(rotation), velocity)

    def _turned(self, time: float) -> tuple[Array, Array]:
        """Return the rotation since the start, in the body frame there, and the spin at a time."""
        j, spin = np.array(self.moments), np.array(self.velocity[3:])
        axes = self._axes(j, spin)
        relabelled = JacobiTop(*(np.abs(axes) @ j), *(axes @ spin))
        before, _ = relabelled.attitude_and_spin(0.0)
        after, later_spin = relabelled.attitude_and_spin(time)
        return axes.T @ before.T @ after @ axes, axes.T @ later_spin

    @staticmethod
    def _axes(j: Array, spin: Array) -> Array:
        """Return the rotation to axes of which the third is the one that the momentum goes around."""
        momentum = j * spin
        around_third = (momentum @ momentum - (spin @ momentum) * j[1]) * (j[2] - j[1]) > 0.0
        swapped = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
        return np.eye(3) if around_third else swapped


@dataclass(frozen=True)
class JacobiTop:
    """A free top whose momentum goes around the third axis; moments in ascending or descending order.

    With L the momentum and T the energy: w1 = A1 cn(tau), w2 = A2 sn(tau), w3 = A3 dn(tau), tau = rate t + tau0. The
    attitude is Rz(phi) Rx(theta) Rz(psi) from the body to a frame with L along z. L as the body has it gives theta and
    psi, and

        phi' = L (J1 w1^2 + J2 w2^2)/(J1^2 w1^2 + J2^2 w2^2),

    whose integral is of the third kind.
    """

    j1: float
    j2: float
    j3: float
    w1: float
    w2: float
    w3: float

    @property
    def _momentum_squared(self) -> float:
        return (self.j1 * self.w1) ** 2 + (self.j2 * self.w2) ** 2 + (self.j3 * self.w3) ** 2

    @property
    def _excess(self) -> tuple[float, float]:
        """2 T J3 - L^2 and L^2 - 2 T J1, each as a sum without cancellation of squares."""
        j1, j2, j3 = self.j1, self.j2, self.j3
        over_third = j1 * (j3 - j1) * self.w1**2 + j2 * (j3 - j2) * self.w2**2
        over_first = j2 * (j2 - j1) * self.w2**2 + j3 * (j3 - j1) * self.w3**2
        return over_third, over_first

    @property
    def _amplitudes(self) -> Array:
        """A1, A2 and A3 [rad/s]."""
        j1, j2, j3 = self.j1, self.j2, self.j3
        over_third, over_first = self._excess
        sense = np.copysign(1.0, self.w3)
        first = np.sqrt(over_third / (j1 * (j3 - j1)))
        second = np.copysign(1.0, j3 - j2) * sense * np.sqrt(over_third / (j2 * (j3 - j2)))
        return np.array([first, second, sense * np.sqrt(over_first / (j3 * (j3 - j1)))])

    def attitude_and_spin(self, time: float) -> tuple[Array, Array]:
        """Return the rotation matrix to the frame along L, and the spin, at a time [s]."""
        j1, j2, j3 = self.j1, self.j2, self.j3
        over_third, over_first = self._excess
        rate = np.sqrt((j3 - j2) * over_first / (j1 * j2 * j3))
        m = (j2 - j1) * over_third / ((j3 - j2) * over_first)
        amplitudes = self._amplitudes
        begin = np.arctan2(self.w2 / amplitudes[1], self.w1 / amplitudes[0])
        sn, cn, dn, amplitude = special().ellipj(special().ellipkinc(begin, m) + rate * time, m)
        spin = amplitudes * np.array([cn, sn, dn])
        precession = self._precession(amplitude, m, rate, time) - self._precession(begin, m, rate, 0.0)
        return self._along_momentum(precession, np.array([j1, j2, j3]) * spin), spin

    def _precession(self, amplitude: float, m: float, rate: float, time: float) -> float:
        """Return phi [rad] as far as the amplitude goes: the integral of L (a + b sn^2)/(c + d sn^2)."""
        j1, j2 = self.j1, self.j2
        first, second, _ = self._amplitudes
        a, c = j1 * first**2, (j1 * first) ** 2
        b, d = j2 * second**2 - a, (j2 * second) ** 2 - c
        third_kind = incomplete_third_kind(-d / c, amplitude, m)
        along = b / d * time + (a - b * c / d) / c * third_kind / rate
        return float(np.sqrt(self._momentum_squared) * along)

    @staticmethod
    def _along_momentum(precession: float, momentum: Array) -> Array:
        """Return Rz(phi) Rx(theta) Rz(psi) for L (sin(theta) sin(psi), sin(theta) cos(psi), cos(theta))."""
        across = np.hypot(momentum[0], momentum[1])
        theta, psi = np.arctan2(across, momentum[2]), np.arctan2(momentum[0], momentum[1])
        return np.asarray(about_z(precession) @ about_x(theta) @ about_z(psi))


def incomplete_third_kind(n: float, amplitude: float, m: float) -> float:
    """Return Pi(n; amplitude | m), the integral of du/(1 - n sn^2 u), for any amplitude and n < 1 (Carlson's forms)."""
    halves = float(np.rint(amplitude / np.pi))
    rest = amplitude - halves * np.pi
    return _third_kind(n, rest, m) + 2.0 * halves * _third_kind(n, 0.5 * np.pi, m)


def _third_kind(n: float, amplitude: float, m: float) -> float:
    s, c = np.sin(amplitude), np.cos(amplitude)
    arguments = c * c, 1.0 - m * s * s, 1.0
    third = n / 3.0 * s**3 * special().elliprj(*arguments, 1.0 - n * s * s)
    return float(s * special().elliprf(*arguments) + third)


@dataclass(frozen=True)
class BroadsideTurn:
    """Planar Kirchhoff motion in the horizontal plane: a pendulum about the position across its momentum.

    Starts at the origin, heading north, without turning. With P the momentum, along n, alpha the angle from n to the
    body's x axis and beta = alpha + pi/2 (- pi/2 if it drifts to port),

        J beta'' = -(1/2) P^2 (1/m1 - 1/m2) sin(2 beta),     sin(beta) = sin(beta0) cd(sigma t | m),  m = sin(beta0)^2,

    with sigma the growth rate of Munk's instability. Angular momentum about the origin gives the way across n, an
    integral of the second kind that along n.

    Attributes:
        surge_mass: m1 [kg].
        sway_mass: m2 > m1 [kg].
        yaw_inertia: J [kg m^2].
        surge: at the start [m/s].
        sway: at the start [m/s], small.
    """

    surge_mass: float
    sway_mass: float
    yaw_inertia: float
    surge: float
    sway: float

    def __call__(self, time: float) -> EndState:
        """Return where the body is at a time [s]."""
        m1, m2, inertia = self.surge_mass, self.sway_mass, self.yaw_inertia
        direction = np.arctan2(m2 * self.sway, m1 * self.surge)  # of P, from north
        momentum = np.hypot(m1 * self.surge, m2 * self.sway)
        side = np.copysign(0.5 * np.pi, direction)
        beta0 = side - direction  # |beta0| < pi/2, and alpha = beta - side
        m = np.sin(beta0) ** 2
        sigma = momentum * np.sqrt((1.0 / m1 - 1.0 / m2) / inertia)
        quarter = special().ellipkm1(np.cos(beta0) ** 2)
        sn, cn, dn, amplitude = special().ellipj(sigma * time + quarter, m)
        beta = np.arctan2(
            np.sin(beta0) * sn, dn
        )  # cos(beta)^2 = dn^2; at the start sn = 1, sin(beta) = sin(beta0)
        rate = np.sin(beta0) * sigma * cn
        along = momentum / m2 * time + momentum * (1.0 / m1 - 1.0 / m2) / sigma * (
            sigma * time - (special().ellipeinc(amplitude, m) - special().ellipe(m))
        )
        across = inertia * rate / momentum
        return self._placed(direction, momentum, along, across, beta - side, rate)

    def _placed(
        self, direction: float, momentum: float, along: float, across: float, alpha: float, rate: float
    ) -> EndState:
        c, s = np.cos(direction), np.sin(direction)
        heading = direction + alpha
        body_momentum = momentum * np.array([np.cos(alpha), -np.sin(alpha)])
        surge, sway = body_momentum / np.array([self.surge_mass, self.sway_mass])
        return EndState(
            np.array([c * along - s * across, s * along + c * across, 0.0]),
            np.array([np.cos(0.5 * heading), 0.0, 0.0, np.sin(0.5 * heading)]),
            np.array([surge, sway, 0.0, 0.0, 0.0, rate]),
        )


def about_x(angle: float) -> Array:
    """Return the matrix of a rotation about x."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def about_z(angle: float) -> Array:
    """Return the matrix of a rotation about z."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def quaternion_matrix(q: Array) -> Array:
    """Return the rotation matrix of a unit quaternion, scalar first."""
    w, v = q[0], q[1:]
    cross = np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])
    return np.asarray(np.eye(3) + 2.0 * w * cross + 2.0 * cross @ cross)


def matrix_quaternion(r: Array) -> Array:
    """Return a unit quaternion, scalar first, of a rotation matrix: from its largest component (Shepperd 1978)."""
    trace = float(np.trace(r))
    squares = np.array([1.0 + trace, *(1.0 - trace + 2.0 * np.diag(r))])  # 4 q_i^2
    largest = int(np.argmax(squares))
    products = np.array(
        [
            [squares[0], r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]],
            [r[2, 1] - r[1, 2], squares[1], r[1, 0] + r[0, 1], r[0, 2] + r[2, 0]],
            [r[0, 2] - r[2, 0], r[1, 0] + r[0, 1], squares[2], r[2, 1] + r[1, 2]],
            [r[1, 0] - r[0, 1], r[0, 2] + r[2, 0], r[2, 1] + r[1, 2], squares[3]],
        ]
    )[largest]
    return np.asarray(products / np.linalg.norm(products))
