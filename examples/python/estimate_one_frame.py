"""estimate_one_frame.py FRAME: a frame folder in, 64 ordered points of the rope out."""

import sys

import flowdlo


def main(path: str) -> None:
    # 1. A frame: numpy arrays and a camera. A live camera's own arrays do as well.
    frame = flowdlo.load_frame_folder(path)

    # 2. An estimator, once: the best GPU, or the CPU; the weights that ship.
    with flowdlo.Estimator() as estimator:
        # 3. An estimate for every frame.
        estimate = estimator.estimate(
            frame.depth_m, frame.mask, frame.intrinsics, frame.color_bgr
        )

    # 4. The nodes, float32 [64, 3] in metres, end to end; and how far to trust them.
    for x, y, z in estimate.nodes:
        print(f"{x:.9g} {y:.9g} {z:.9g}")
    print(f"confidence {estimate.confidence:.3f}", file=sys.stderr)


if __name__ == "__main__":
    try:
        main(sys.argv[1] if len(sys.argv) > 1 else ".")
    except flowdlo.Error as error:
        sys.exit(str(error))
