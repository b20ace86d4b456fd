"""A vehicle of your own: start from one of the catalogue, change its numbers, check it, fly it."""

import tempfile
from pathlib import Path

import gymnasium as gym

import dq_marine
from dq_marine.vehicles.export import export_vehicle


def main() -> None:
    """Hang a battery of 2 kg under a BlueROV2 Heavy and ballast it with foam."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "my_rov.toml"
        export_vehicle(
            "bluerov2_heavy", file
        )  # in a shell: dq-marine vehicles export bluerov2_heavy my_rov.toml
        text = file.read_text()
        file.write_text(
            text.replace("mass = 13.5", "mass = 15.5").replace("volume = 0.0134", "volume = 0.0154")
        )

        for one in ("bluerov2_heavy", file):
            vehicle = dq_marine.load_vehicle(
                one
            )  # checks fields, units and physics; errors say what is wrong where
            sheet = dq_marine.vehicle_sheet(vehicle)
            surge = sheet.terminal_speed["surge"]
            print(
                f"{sheet.name}: {sheet.dry_mass:g} kg, roll period {sheet.roll_period:.2f} s, {surge:.2f} m/s ahead"
            )

        env = gym.make("dq_marine/StationKeeping-v0", vehicle=str(file))
        env.reset(seed=0)
        info = env.step(env.action_space.sample())[4]
        print(f"position error after a step: {info['position_error']:.3f} m")


if __name__ == "__main__":
    main()
