"""Distributions of one number, as a randomisation file names them; each lies within finite limits."""

from __future__ import annotations

import math
from statistics import NormalDist
from typing import Annotated, Any, Self, TypeAlias

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, Discriminator, Tag, model_validator

from dq_marine.physics.fields import Positive, Table


def _ordered(limits: tuple[float, float]) -> tuple[float, float]:
    if limits[0] > limits[1]:
        raise ValueError("the lower limit is above the upper one; give [lower, upper]")
    return limits


Limits: TypeAlias = Annotated[tuple[float, float], AfterValidator(_ordered)]


class Uniform(Table):
    """Equally likely everywhere between two limits.

    Attributes:
        uniform: lower and upper limit; equal ones give a constant.
    """

    uniform: Limits

    @property
    def limits(self) -> tuple[float, float]:
        """Between which all draws lie."""
        return self.uniform

    def quantile(self, share: float) -> float:
        """Return the number below which a share of all draws lies, from 0 to 1."""
        low, high = self.uniform
        return min(high, low + (high - low) * share)


class LogUniform(Table):
    """A number whose logarithm is equally likely everywhere: as often twice as half.

    Attributes:
        log_uniform: lower and upper limit, above 0.
    """

    log_uniform: Annotated[tuple[Positive, Positive], AfterValidator(_ordered)]

    @property
    def limits(self) -> tuple[float, float]:
        """Between which all draws lie."""
        return self.log_uniform

    def quantile(self, share: float) -> float:
        """Return the number below which a share of all draws lies, from 0 to 1."""
        low, high = self.log_uniform
        return min(high, max(low, low * math.exp(share * math.log(high / low))))


class TruncatedNormal(Table):
    """A normal distribution of which only what lies between two limits is drawn.

    Attributes:
        normal: mean and standard deviation, before it is cut.
        within: lower and upper limit, with the mean between them.
    """

    normal: tuple[float, Positive]
    within: Limits

    @model_validator(mode="after")
    def _mean_within(self) -> Self:
        if not self.within[0] <= self.normal[0] <= self.within[1]:
            raise ValueError("the mean lies outside the limits; give within = [lower, upper] around it")
        return self

    @property
    def limits(self) -> tuple[float, float]:
        """Between which all draws lie."""
        return self.within

    def quantile(self, share: float) -> float:
        """Return the number below which a share of all draws lies, from 0 to 1."""
        normal, (low, high) = NormalDist(*self.normal), self.within
        below, above = normal.cdf(low), normal.cdf(high)
        probability = below + (above - below) * share
        if not 0.0 < probability < 1.0:  # beyond what double precision tells from the limit
            return low if probability <= 0.0 else high
        return min(high, max(low, normal.inv_cdf(probability)))


AnyDistribution: TypeAlias = Uniform | LogUniform | TruncatedNormal

KINDS: dict[str, type[AnyDistribution]] = {
    "uniform": Uniform,
    "log_uniform": LogUniform,
    "normal": TruncatedNormal,
}


def _kind(value: Any) -> str | None:
    """Return which distribution a value from a file, or one made in code, is."""
    for name, kind in KINDS.items():
        if isinstance(value, kind) or (isinstance(value, dict) and name in value):
            return name
    return None


Distribution: TypeAlias = Annotated[
    Annotated[Uniform, Tag("uniform")]
    | Annotated[LogUniform, Tag("log_uniform")]
    | Annotated[TruncatedNormal, Tag("normal")],
    Discriminator(
        _kind,
        custom_error_type="no_distribution",
        custom_error_message=(
            "not a distribution; give { uniform = [lower, upper] }, { log_uniform = [lower, upper] } or "
            "{ normal = [mean, deviation], within = [lower, upper] }"
        ),
    ),
]
"""Distribution of one number."""


def between(lowest: float, highest: float, what: str) -> Any:
    """Return a validator of distributions all of whose draws must lie between two limits."""

    def check(distribution: AnyDistribution) -> AnyDistribution:
        low, high = distribution.limits
        if not lowest <= low <= high <= highest:
            raise ValueError(
                f"draws from {low:g} to {high:g}; {what} lies between {lowest:g} and {highest:g}"
            )
        return distribution

    return AfterValidator(check)


Factor: TypeAlias = Annotated[Distribution, between(0.01, 100.0, "a factor on the vehicle's own number")]
Offset: TypeAlias = Annotated[Distribution, between(-10.0, 10.0, "an offset in m")]
Angle: TypeAlias = Annotated[Distribution, between(-60.0, 60.0, "an angle of rest in degrees")]
NetWeight: TypeAlias = Annotated[Distribution, between(-0.5, 0.5, "a share of the weight")]


OneOrEach = Discriminator(lambda value: "each" if isinstance(value, list | tuple) else "one")

Factors3: TypeAlias = Annotated[
    Annotated[Factor, Tag("one")] | Annotated[tuple[Factor, Factor, Factor], Tag("each")], OneOrEach
]
Factors6: TypeAlias = Annotated[
    Annotated[Factor, Tag("one")]
    | Annotated[tuple[Factor, Factor, Factor, Factor, Factor, Factor], Tag("each")],
    OneOrEach,
]
Offsets3: TypeAlias = Annotated[
    Annotated[Offset, Tag("one")] | Annotated[tuple[Offset, Offset, Offset], Tag("each")], OneOrEach
]
"""One distribution for all axes, each of which draws for itself; or one for each axis."""


def drawn(distribution: AnyDistribution, rng: np.random.Generator) -> float:
    """Return a draw, which takes one uniform number of the generator's, whatever the distribution."""
    return distribution.quantile(rng.random())


def drawn_for_each(
    distributions: AnyDistribution | tuple[AnyDistribution, ...], size: int, rng: np.random.Generator
) -> NDArray[np.float64]:
    """Return a draw for each axis, shape (size,), from one distribution for all, or one for each."""
    each = distributions if isinstance(distributions, tuple) else (distributions,) * size
    return np.array([drawn(distribution, rng) for distribution in each])
