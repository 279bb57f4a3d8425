/* estimate_one_frame FRAME: a frame folder in, 64 ordered points of the rope out. C99. */
#include <flowdlo/flowdlo.h>
#include <stdio.h>

static int report(const char* what) {
  fprintf(stderr, "%s: %s\n", what, flowdlo_last_error());
  return 1;
}

int main(int argc, char** argv) {
  /* 1. A frame. A live camera fills a flowdlo_frame itself: pixels, sizes, strides, intrinsics. */
  flowdlo_frame_folder* folder = NULL;
  flowdlo_frame frame;
  if (flowdlo_frame_folder_load(argc > 1 ? argv[1] : ".", &folder)) return report("frame");
  flowdlo_frame_init(&frame, sizeof frame);
  flowdlo_frame_folder_frame(folder, &frame);

  /* 2. An estimator, once; NULL stands for the default configuration. */
  flowdlo_estimator* estimator = NULL;
  if (flowdlo_estimator_create(NULL, &estimator)) return report("estimator");

  /* 3. An estimate for every frame: nodes in metres, and how far to trust them. */
  flowdlo_estimate estimate;
  flowdlo_estimate_init(&estimate, sizeof estimate);
  if (flowdlo_estimator_estimate(estimator, &frame, &estimate)) return report("estimate");
  for (int i = 0; i < FLOWDLO_NODES; ++i) {
    const float* node = estimate.nodes[i];
    printf("%.9g %.9g %.9g\n", node[0], node[1], node[2]);
  }
  fprintf(stderr, "confidence %g\n", estimate.confidence);

  flowdlo_estimator_destroy(estimator);
  flowdlo_frame_folder_destroy(folder);
  return 0;
}
