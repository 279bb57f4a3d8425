"""plot_estimate.py FRAME [PICTURE]: the estimate over the image and in space.

Without PICTURE it opens a window. Needs matplotlib.
"""

import sys

import flowdlo

try:
    import matplotlib.pyplot as plt
except ImportError:
    print("plot_estimate.py: expected matplotlib, found none; install it", file=sys.stderr)
    sys.exit(2)


def background(frame):
    """Colour where there is some, otherwise depth."""
    return frame.depth_m if frame.color_bgr is None else frame.color_bgr[..., ::-1]


def draw(frame, estimate):
    x, y, z = estimate.nodes.T
    fx, fy, cx, cy = frame.intrinsics
    figure = plt.figure(figsize=(12, 5))

    image = figure.add_subplot(1, 2, 1)
    image.imshow(background(frame))
    image.plot(fx * x / z + cx, fy * y / z + cy, color="white", linewidth=1)
    drawn = image.scatter(
        fx * x / z + cx, fy * y / z + cy, c=1000 * estimate.sigma_m, s=12, zorder=2
    )
    figure.colorbar(drawn, ax=image, label="sigma, mm", shrink=0.7)
    image.set_title(f"{estimate.source}, confidence {estimate.confidence:.2f}")
    image.set_axis_off()

    space = figure.add_subplot(1, 2, 2, projection="3d")
    space.plot(x, z, -y, color="grey", linewidth=1)
    seen = estimate.support
    space.scatter(x[seen], z[seen], -y[seen], s=10, label="measured")
    space.scatter(x[~seen], z[~seen], -y[~seen], s=10, marker="x", label="not measured")
    if frame.truth is not None:
        tx, ty, tz = frame.truth.T
        space.plot(tx, tz, -ty, linestyle="--", linewidth=1, label="truth")
    space.set_xlabel("x, m")
    space.set_ylabel("z, m")
    space.set_zlabel("-y, m")
    space.legend()
    return figure


def main(path, picture=None):
    frame = flowdlo.load_frame_folder(path)
    with flowdlo.Estimator() as estimator:
        estimate = estimator.estimate(
            frame.depth_m, frame.mask, frame.intrinsics, frame.color_bgr
        )
    figure = draw(frame, estimate)
    if picture is None:
        plt.show()
    else:
        figure.savefig(picture, dpi=100)


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 3:
        sys.exit(__doc__)
    try:
        main(*sys.argv[1:])
    except flowdlo.Error as error:
        sys.exit(str(error))
