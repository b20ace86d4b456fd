"""The things around a vehicle: each form is drawn when it first appears, and hidden while it is not there."""

from __future__ import annotations

from dq_marine.task.things import Form
from dq_marine.viewer.models.thing_models import thing_model
from dq_marine.viewer.placement import Placement, hidden_at, quaternion_wxyz, vector3
from dq_marine.viewer.snapshot import Snapshot
from dq_marine.viewer.transport.messages import Message, delete, set_object
from dq_marine.viewer.transport.three_json import painted_surface

THINGS = "/world/things"


class Things:
    """Which things have been drawn, and where."""

    def __init__(self) -> None:
        """Begin with none."""
        self._paths: dict[tuple[int, Form], str] = {}
        self._drawn = 0

    def forget(self) -> list[Message]:
        """Take away what has been drawn."""
        messages = [delete(path) for path in self._paths.values()]
        self._paths = {}
        return messages

    def appear(self, snapshot: Snapshot) -> list[Message]:
        """Draw what a snapshot has and no snapshot before it had."""
        messages = []
        for slot, thing in enumerate(snapshot.things):
            if (slot, thing.form) not in self._paths:
                path = self._paths[slot, thing.form] = f"{THINGS}/{self._drawn}"
                self._drawn += 1  # never the same path again: pages may come late to what was there before
                messages.append(set_object(path, painted_surface(path, *thing_model(thing.form))))
        return messages

    def placements(self, snapshot: Snapshot) -> dict[str, Placement]:
        """Return where each of them stands at a snapshot, by path."""
        nowhere = hidden_at(vector3(snapshot.position_ned))
        places = dict.fromkeys(self._paths.values(), nowhere)
        for slot, thing in enumerate(snapshot.things):
            path = self._paths[slot, thing.form]
            places[path] = Placement(vector3(thing.position_ned), quaternion_wxyz(thing.attitude))
        return places
