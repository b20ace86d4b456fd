"""A catamaran in a sea and a gusty wind: how it heaves and drifts. Waves act through what its file says of its hull."""

import numpy as np

from dq_marine import Jonswap, Scene, Sea, SlowDrift, Wind


def main() -> None:
    """Let an Otter float for a minute, with nobody at the helm."""
    sea = Sea(
        Jonswap(height=0.3, period=4.0), direction=0.7, seed=1
    )  # heading north-east; the seed fixes every wave
    scene = Scene("otter", weather=[sea, SlowDrift(sea), Wind(6.0, direction_from=3.8, gusts=True)])
    print(scene)
    boat = scene.stepper()
    boat.reset(position_ned=(0.0, 0.0, scene.vehicle.equilibrium_depth))
    depths = []
    for second in range(60):
        for _ in range(10):
            boat.step(steps=5)  # of 0.02 s
            depths.append(boat.position_ned[2])
        if second % 15 == 14:
            north, east, _ = boat.position_ned
            print(f"{boat.time:4.0f} s: {north:6.2f} m north, {east:6.2f} m east")
    print(f"heave: significant height {4.0 * np.std(depths):.2f} m in a sea of {sea.spectrum.height:.2f} m")
    # In an environment: gym.make(..., vehicle="otter", weather=[...]); a look at a sea: dq-marine sea --plot sea.png


if __name__ == "__main__":
    main()
