"""Many bodies at once without Gymnasium: the simulator alone, in SIMD lanes and threads, with the bits of one body."""

import time

import numpy as np

from dq_marine import Scene


def main() -> None:
    """Push 4,096 vehicles with different forces, and one of them alone."""
    scene = Scene("bluerov2_heavy", current=(0.3, 0.0, 0.0), step=0.02)
    count = 4096
    wrenches = np.zeros((count, 6))  # surge, sway, heave [N], roll, pitch, yaw [N m], body frame
    wrenches[:, 0] = np.linspace(-60.0, 60.0, count)
    wrenches[:, 5] = np.linspace(-3.0, 3.0, count)

    batch = scene.batch(count)
    batch.step(wrench_body=wrenches, steps=1)
    begun = time.perf_counter()
    batch.step(wrench_body=wrenches, steps=499)
    rate = 499 * count / (time.perf_counter() - begun)
    print(f"{rate / 1e6:.1f} million steps a second")
    print("extreme north positions [m]:", batch.position_ned[:, 0].min(), batch.position_ned[:, 0].max())

    alone = scene.stepper()
    alone.step(wrench_body=wrenches[77], steps=1)
    alone.step(wrench_body=wrenches[77], steps=499)
    print("body 77 has the bits of one alone:", np.array_equal(alone.position_ned, batch.position_ned[77]))


if __name__ == "__main__":
    main()
