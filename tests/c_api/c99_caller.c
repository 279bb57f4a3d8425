#include "c99_caller.h"

flowdlo_status c99_estimate(const char* path, const char* weights, int steps, int draws,
                            flowdlo_estimate* estimate, flowdlo_alternative* alternatives,
                            int capacity) {
  flowdlo_config config;
  flowdlo_frame frame;
  flowdlo_frame_folder* folder = NULL;
  flowdlo_estimator* estimator = NULL;
  flowdlo_status status;
  int i;

  status = flowdlo_config_init(&config, sizeof config);
  config.weights = weights;
  config.device = "cpu";
  config.euler_steps = steps;
  config.draws = draws;
  if (status == FLOWDLO_OK) status = flowdlo_frame_init(&frame, sizeof frame);
  if (status == FLOWDLO_OK) status = flowdlo_estimate_init(estimate, sizeof *estimate);
  if (status == FLOWDLO_OK) status = flowdlo_frame_folder_load(path, &folder);
  if (status == FLOWDLO_OK) status = flowdlo_frame_folder_frame(folder, &frame);
  if (status == FLOWDLO_OK) status = flowdlo_estimator_create(&config, &estimator);
  if (status == FLOWDLO_OK) status = flowdlo_estimator_estimate(estimator, &frame, estimate);
  for (i = 0; status == FLOWDLO_OK && i < capacity && i < estimate->alternatives; ++i) {
    status = flowdlo_alternative_init(&alternatives[i], sizeof alternatives[i]);
    if (status == FLOWDLO_OK) {
      status = flowdlo_estimator_alternative(estimator, i, &alternatives[i]);
    }
  }
  flowdlo_estimator_destroy(estimator);
  flowdlo_frame_folder_destroy(folder);
  return status;
}

flowdlo_status c99_estimate_camera(flowdlo_estimator* estimator, const uint16_t* depth,
                                   ptrdiff_t depth_row_bytes, const uint8_t* mask,
                                   flowdlo_estimate* estimate) {
  flowdlo_frame frame;
  flowdlo_frame_init(&frame, sizeof frame);
  frame.width = 640;
  frame.height = 480;
  frame.fx = 605.1F;
  frame.fy = 605.2F;
  frame.cx = 321.4F;
  frame.cy = 241.9F;
  frame.depth = (flowdlo_image){depth, depth_row_bytes, 0, FLOWDLO_PIXEL_U16, 0};
  frame.depth_scale_m = 0.001;
  frame.mask = (flowdlo_image){mask, 0, 0, FLOWDLO_PIXEL_U8, 0};
  return flowdlo_estimator_estimate(estimator, &frame, estimate);
}

void c99_sizes(size_t sizes[4]) {
  sizes[0] = sizeof(flowdlo_config);
  sizes[1] = sizeof(flowdlo_frame);
  sizes[2] = sizeof(flowdlo_estimate);
  sizes[3] = sizeof(flowdlo_alternative);
}
