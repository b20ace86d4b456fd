"""Vehicles beside what was measured or computed elsewhere: trials run again, with a verdict for each number."""

from dq_marine.validation.comparison import Comparison, Line, Verdict, compared
from dq_marine.validation.references import References, load_references, validated_vehicles

__all__ = [
    "Comparison",
    "Line",
    "References",
    "Verdict",
    "compared",
    "load_references",
    "validated_vehicles",
]
