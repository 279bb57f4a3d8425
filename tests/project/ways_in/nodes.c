/* nodes FRAME: its 64 nodes, from C. */
#include <flowdlo/flowdlo.h>
#include <stdio.h>

int main(int argc, char** argv) {
  flowdlo_frame_folder* folder = NULL;
  flowdlo_estimator* estimator = NULL;
  flowdlo_config config;
  flowdlo_frame frame;
  flowdlo_estimate estimate;
  flowdlo_config_init(&config, sizeof config);
  config.device = "cpu";
  flowdlo_frame_init(&frame, sizeof frame);
  flowdlo_estimate_init(&estimate, sizeof estimate);
  if (argc != 2 || flowdlo_frame_folder_load(argv[1], &folder))
    return puts(flowdlo_last_error()), 1;
  flowdlo_frame_folder_frame(folder, &frame);
  if (flowdlo_estimator_create(&config, &estimator)) return puts(flowdlo_last_error()), 1;
  if (flowdlo_estimator_estimate(estimator, &frame, &estimate))
    return puts(flowdlo_last_error()), 1;
  for (int i = 0; i < FLOWDLO_NODES; ++i) {
    printf("%.9g %.9g %.9g\n", estimate.nodes[i][0], estimate.nodes[i][1], estimate.nodes[i][2]);
  }
  flowdlo_estimator_destroy(estimator);
  flowdlo_frame_folder_destroy(folder);
  return 0;
}
