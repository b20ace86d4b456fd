"""What sensors tell of a motion: scale, bias that walks, noise, a rate, drop-outs.

A channel whose true value is x reads

    g x + b + n,    b(t + T) = b(t) + w sqrt(T) times a normal number,    n normal                      (N1)

with a gain g and a first bias b that an episode draws. A sensor reads at its own interval, unless a reading is lost: at
random, or because there is nothing to be measured. In between it holds its last reading, and tells how old that is.
The first reading, at an episode's start, is never lost.

An `Instrument` is one kind of sensor, as functions; its errors are those of three channels, whose last may be absent.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.normal import normal_pair
from dq_marine.algebra.selection import select, spread
from dq_marine.algebra.vector3 import Vector3, add, multiply_elementwise
from dq_marine.integrator.body import Motion

LATE = 1e-3
"""Of a control period: a reading is due that early, so that round-off does not put it off to the next."""


class SensorNumbers(NamedTuple):
    """How good a sensor is; vectors have a number for each channel.

    Attributes:
        noise: standard deviation of a reading's noise.
        bias: of the first bias.
        walk: of what the bias gains in a control period.
        scale: of the gain, about 1.
        interval: between readings, at least a control period [s].
        period: control period [s].
        dropout: probability that a reading is lost.
        limits: of what can be measured, as the instrument takes them.
    """

    noise: Vector3
    bias: Vector3
    walk: Vector3
    scale: Vector3
    interval: float
    period: float
    dropout: float
    limits: tuple[float, float]


class Reading(NamedTuple):
    """A sensor's state.

    Attributes:
        values: what it read last.
        bias: of each channel now.
        gain: of each channel.
        clock: since a reading was last due [s].
        age: of the values [s].
        carried: of the last motion, what the instrument's next reading needs.
    """

    values: Any
    bias: Vector3
    gain: Vector3
    clock: float
    age: float
    carried: Any


def always(numbers: SensorNumbers, motion: Motion) -> bool:
    """Return True: there is always something to be measured."""
    return spread(True, motion.position_ned[2])


def carry_nothing(motion: Motion) -> tuple[()]:
    """Return nothing: a reading needs only the present motion."""
    return ()


def believe_nothing(values: Any, motion: Motion) -> Motion:
    """Return the motion: what is measured is not part of it."""
    return motion


def show_nothing(values: Any) -> tuple[()]:
    """Return nothing: the values are observed in place of what is true."""
    return ()


class Instrument(NamedTuple):
    """A kind of sensor: plain functions, compiled like a task's. By default it always measures and shows nothing.

    Attributes:
        channels: 1 to 3, those that have errors of their own.
        blank: values and what is carried, as zeros.
        measure: (numbers, gain, offset, carried, motion) -> values.
        available: (numbers, motion) -> whether there is something to be measured.
        carry: (motion) -> what the next reading needs of it.
        believe: (values, motion) -> the motion with what is measured in place of what is true.
        show: (values) -> nested tuples of numbers that join the observation by themselves.
    """

    channels: int
    blank: tuple[Any, Any]
    measure: Callable[[SensorNumbers, Vector3, Vector3, Any, Motion], Any]
    available: Callable[[SensorNumbers, Motion], bool] = always
    carry: Callable[[Motion], Any] = carry_nothing
    believe: Callable[[Any, Motion], Motion] = believe_nothing
    show: Callable[[Any], Any] = show_nothing


def one_channel(uniforms: tuple[float, ...]) -> tuple[Vector3, Vector3]:
    """Return two normal numbers for the first channel from two uniform ones."""
    a, b = normal_pair(uniforms[0], uniforms[1])
    return (a, 0.0, 0.0), (b, 0.0, 0.0)


def two_channels(uniforms: tuple[float, ...]) -> tuple[Vector3, Vector3]:
    """Return two normal numbers for each of two channels from four uniform ones."""
    a, b = normal_pair(uniforms[0], uniforms[1])
    c, d = normal_pair(uniforms[2], uniforms[3])
    return (a, c, 0.0), (b, d, 0.0)


def three_channels(uniforms: tuple[float, ...]) -> tuple[Vector3, Vector3]:
    """Return two normal numbers for each of three channels from six uniform ones."""
    a, b = normal_pair(uniforms[0], uniforms[1])
    c, d = normal_pair(uniforms[2], uniforms[3])
    e, f = normal_pair(uniforms[4], uniforms[5])
    return (a, c, e), (b, d, f)


NORMALS = {1: one_channel, 2: two_channels, 3: three_channels}
"""By the number of channels."""


def first_draws(instrument: Instrument) -> int:
    """Return how many uniform random numbers an episode's first reading takes."""
    return 4 * instrument.channels


def later_draws(instrument: Instrument) -> int:
    """Return how many uniform random numbers a control period takes."""
    return 2 * instrument.channels + 1


def make_first_reading(
    instrument: Instrument,
) -> Callable[[SensorNumbers, Motion, tuple[float, ...]], Reading]:
    """Return (numbers, motion, uniforms) -> the reading at an episode's start."""
    measure, carry, normals = instrument.measure, instrument.carry, NORMALS[instrument.channels]
    half = 2 * instrument.channels

    def first_reading(numbers: SensorNumbers, motion: Motion, uniforms: tuple[float, ...]) -> Reading:
        biased, noisy = normals(uniforms)
        scaled, _ = normals(uniforms[half:])
        bias = multiply_elementwise(numbers.bias, biased)
        gain = add((1.0, 1.0, 1.0), multiply_elementwise(numbers.scale, scaled))
        offset = add(bias, multiply_elementwise(numbers.noise, noisy))
        carried = carry(motion)
        return Reading(measure(numbers, gain, offset, carried, motion), bias, gain, 0.0, 0.0, carried)

    return first_reading


def make_later_reading(
    instrument: Instrument,
) -> Callable[[SensorNumbers, Reading, Motion, tuple[float, ...]], Reading]:
    """Return (numbers, reading, motion, uniforms) -> the reading at the end of the next control period."""
    measure, available, carry = instrument.measure, instrument.available, instrument.carry
    normals = NORMALS[instrument.channels]
    last = 2 * instrument.channels

    def later_reading(
        numbers: SensorNumbers, reading: Reading, motion: Motion, uniforms: tuple[float, ...]
    ) -> Reading:
        walked, noisy = normals(uniforms)
        bias = add(reading.bias, multiply_elementwise(numbers.walk, walked))  # (N1)
        offset = add(bias, multiply_elementwise(numbers.noise, noisy))
        clock = reading.clock + numbers.period
        due = clock >= numbers.interval - LATE * numbers.period
        fresh = due & (uniforms[last] >= numbers.dropout) & available(numbers, motion)
        values = measure(numbers, reading.gain, offset, reading.carried, motion)
        return Reading(
            select(fresh, values, reading.values),
            bias,
            reading.gain,
            select(due, clock - numbers.interval, clock),
            select(fresh, 0.0, reading.age + numbers.period),
            carry(motion),
        )

    return later_reading
