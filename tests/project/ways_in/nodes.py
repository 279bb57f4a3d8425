"""nodes.py FRAME: its 64 nodes, from Python."""

import sys

import flowdlo

frame = flowdlo.load_frame_folder(sys.argv[1])
with flowdlo.Estimator(device="cpu") as estimator:
    estimate = estimator.estimate(
        frame.depth_m, frame.mask, frame.intrinsics, frame.color_bgr
    )
for x, y, z in estimate.nodes:
    print(f"{x:.9g} {y:.9g} {z:.9g}")
