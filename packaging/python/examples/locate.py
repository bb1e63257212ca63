# %% [markdown]
# # Where was this scan taken?
#
# A recorded drive through a corridor: the map, a scan of the laser, and where on the map the
# scan fits. Nothing is known beforehand, neither position nor heading.
#
# As a script it writes a picture: `python examples/locate.py [PICTURE]`. It needs
# `pip install backcast[examples]` and the recordings of the repository.

# %%
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Ellipse

import backcast

here = Path(__file__).resolve() if "__file__" in globals() else Path.cwd() / "examples/locate.py"
folder = here.parents[3] / "recordings/malaga_corridor"

# %% [markdown]
# ## The map
#
# Preparing it takes a moment; then it can be asked as often as wanted, by any number of
# threads.

# %%
map = backcast.Map.from_yaml(folder / "map.yaml")
localizer = backcast.Localizer(map)
print(map)

# %% [markdown]
# ## A scan
#
# Ranges in metres, angles in radians, as `sensor_msgs/LaserScan` has them, and the mount of the
# laser: it sits 0.78 m ahead of the robot's base.

# %%
scan = backcast.read(folder / "recording.mcap").scans["/scan"][0]
print(scan, scan.mount)

# %% [markdown]
# ## The places where it may have been taken

# %%
result = localizer.locate(scan)
print(result)
best = slice(5)
for pose, probability, score in zip(
    result.poses[best], result.probabilities[best], result.scores[best], strict=True
):
    print(
        f"x {pose[0]:8.3f} m  y {pose[1]:8.3f} m  yaw {np.degrees(pose[2]):7.2f}°"
        f"  probability {probability:.4f}  fit {score:.2f}"
    )

# %% [markdown]
# ## A picture


# %%
def transformed(pose, xs, ys):
    """Points of a frame in the map, where the frame has this pose."""
    x, y, yaw = pose
    return x + np.cos(yaw) * xs - np.sin(yaw) * ys, y + np.sin(yaw) * xs + np.cos(yaw) * ys


def draw_map(axes):
    """Free cells white, unknown ones grey, occupied ones black."""
    x, y, _ = map.origin  # This map is not turned.
    extent = (x, x + map.width * map.resolution, y, y + map.height * map.resolution)
    shades = np.where(map.cells < 0, 40, map.cells)
    axes.imshow(shades, cmap="gray_r", vmin=0, vmax=100, origin="lower", extent=extent)
    axes.set_aspect("equal")
    axes.set_xlabel("x, m")
    axes.set_ylabel("y, m")


def draw_pose(axes, pose, colour, length):
    x, y, yaw = pose
    arrow = dict(arrowstyle="-|>", color=colour, linewidth=2)
    tip = (x + length * np.cos(yaw), y + length * np.sin(yaw))
    axes.annotate("", tip, (x, y), arrowprops=arrow)


def draw_ellipse(axes, pose, covariance, deviations):
    """Where the position lies by so many standard deviations."""
    values, vectors = np.linalg.eigh(covariance[:2, :2])
    angle = np.degrees(np.arctan2(vectors[1, 1], vectors[0, 1]))
    width, height = 2 * deviations * np.sqrt(values[::-1])
    axes.add_patch(Ellipse(pose[:2], width, height, angle=angle, color="tab:red", alpha=0.4))


figure, (whole, near) = plt.subplots(2, 1, figsize=(11, 6), constrained_layout=True)
figure.suptitle(f"{result.verdict}: {result.why}")

draw_map(whole)
for pose in result.poses[1:]:
    draw_pose(whole, pose, "tab:blue", 2.0)
draw_pose(whole, result.pose, "tab:red", 4.0)
whole.set_title(f"the best place in red, {len(result.poses) - 1} others in blue", fontsize=10)

ranges = scan.ranges
bearings = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
hit = np.isfinite(ranges) & (ranges >= scan.range_min) & (ranges < scan.range_max)
ends = transformed(
    result.laser_poses[0], ranges[hit] * np.cos(bearings[hit]), ranges[hit] * np.sin(bearings[hit])
)
draw_map(near)
near.plot(*ends, ".", color="tab:orange", markersize=4, label="ends of the beams")
near.plot(*result.laser_poses[0, :2], "o", color="tab:green", label="laser")
draw_pose(near, result.pose, "tab:red", 1.5)
draw_ellipse(near, result.pose, result.covariance, deviations=3)
near.set_xlim(ends[0].min() - 2, ends[0].max() + 2)
near.set_ylim(ends[1].min() - 2, ends[1].max() + 2)
near.set_title("the scan at the best place; the arrow begins at the base", fontsize=10)
near.legend(loc="lower right")

if __name__ == "__main__" and "ipykernel" not in sys.modules:
    picture = sys.argv[1] if len(sys.argv) > 1 else "locate.png"
    figure.savefig(picture, dpi=100)
    print(f"{picture} is written")
