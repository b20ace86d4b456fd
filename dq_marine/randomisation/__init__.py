"""Domain randomisation: vehicles like a given one, drawn from distributions that stand in a file."""

from dq_marine.randomisation.files import randomisation_names
from dq_marine.randomisation.model import Randomisation
from dq_marine.randomisation.spread import Spread, spread_of

__all__ = ["Randomisation", "Spread", "randomisation_names", "spread_of"]
