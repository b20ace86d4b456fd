"""Imazu's problem: 22 meetings of ships on which collision avoidance is tried, as plain numbers.

Imazu, H. (1987). Research on collision avoidance manoeuvre. Doctoral thesis, University of Tokyo (in Japanese); in
English in Cai, Y., Hasegawa, K. (2013). Evaluating of marine traffic simulation system through Imazu problem. Proc.
JASNAOE 16, and in Sawada, R., Sato, K., Majima, T. (2021). Automatic ship collision avoidance using deep
reinforcement learning with LSTM in continuous action spaces. J. Marine Sci. Technol. 26, 509-524.

All ships keep course and speed, and their straight tracks meet at one point at one time. The angles are those of the
open implementation tud_rl (its environment MMG_Imazu), which names the last of these; the papers themselves were not
seen. Others print some angles a few degrees otherwise. Case 8 with the second ship from starboard would be case 5;
here it comes from port, as the open colav-simulator has it.
"""

from __future__ import annotations

SLOW = 0.7
"""Speed of a slow ship over that of one's own; all others are as fast as one's own."""

IMAZU_CASES: tuple[tuple[tuple[float, float], ...], ...] = (
    ((180.0, 1.0),),
    ((-90.0, 1.0),),
    ((0.0, SLOW),),
    ((45.0, 1.0),),
    ((180.0, 1.0), (-90.0, 1.0)),
    ((-10.0, 1.0), (-45.0, 1.0)),
    ((0.0, SLOW), (-45.0, 1.0)),
    ((180.0, 1.0), (90.0, 1.0)),
    ((-30.0, 1.0), (-90.0, 1.0)),
    ((-90.0, 1.0), (15.0, 1.0)),
    ((90.0, 1.0), (-30.0, 1.0)),
    ((180.0, 1.0), (-45.0, 1.0), (-10.0, 1.0)),
    ((180.0, 1.0), (10.0, 1.0), (45.0, 1.0)),
    ((-10.0, 1.0), (-45.0, 1.0), (-90.0, 1.0)),
    ((0.0, SLOW), (-45.0, 1.0), (-90.0, 1.0)),
    ((45.0, 1.0), (90.0, 1.0), (-90.0, 1.0)),
    ((0.0, SLOW), (10.0, 1.0), (-45.0, 1.0)),
    ((-135.0, 1.0), (-15.0, 1.0), (-30.0, 1.0)),
    ((15.0, 1.0), (-15.0, 1.0), (-135.0, 1.0)),
    ((0.0, SLOW), (-15.0, 1.0), (-90.0, 1.0)),
    ((-15.0, 1.0), (15.0, 1.0), (-90.0, 1.0)),
    ((0.0, SLOW), (-45.0, 1.0), (-90.0, 1.0)),
)
"""Of each case, of each other ship: its heading less one's own [degrees, clockwise], and its speed over one's own."""
