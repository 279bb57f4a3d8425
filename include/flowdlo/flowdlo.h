/* FlowDLO for C: the complete ordered 3D centerline of a rope from one RGB-D frame. C99 or later.
 *
 * Every call that can fail returns a flowdlo_status: FLOWDLO_OK, or why there is no value; then
 * flowdlo_last_error() says who failed, what was expected, what came and what to do. No call throws
 * or ends the process: a null pointer where one is needed, a struct that was not filled by its
 * _init function, and images of the wrong size or kind are FLOWDLO_BAD_INPUT. What a call would
 * have written is untouched when it fails.
 *
 * A struct that begins with struct_size may get more fields at its end in later versions: its _init
 * function writes the size and every default. A program built with an older header keeps working
 * with a newer library. A struct that is larger than the library knows is FLOWDLO_BAD_INPUT.
 *
 * Threads: one estimator is used by one thread at a time; different estimators, and all calls
 * without one, may run at the same time. Ownership: what a _create or _load function returns is
 * freed by its _destroy function, which takes NULL as well. Strings are UTF-8 and end in 0. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "flowdlo/export.hpp"  /* macros only, as the next: C reads them as well */
#include "flowdlo/version.hpp" /* FLOWDLO_VERSION: that of this header */

#ifdef __cplusplus
extern "C" {
#endif

enum { FLOWDLO_NODES = 64 };

/* Why a call has no value. Stable: programs may switch on it. */
typedef int32_t flowdlo_status;
enum {
  FLOWDLO_OK = 0,
  FLOWDLO_BAD_INPUT = 1,    /* an argument, frame, file or configuration violates its contract */
  FLOWDLO_NO_EVIDENCE = 2,  /* no mask pixel carries a usable depth */
  FLOWDLO_NO_PATH = 3,      /* the mask holds no stroke that a rope could have drawn */
  FLOWDLO_BAD_WEIGHTS = 4,  /* the weights file is missing, damaged, or of another model */
  FLOWDLO_NO_DEVICE = 5,    /* no device fits what was asked for */
  FLOWDLO_DEVICE_LOST = 6,  /* the device failed, hung past its timeout, or ran out of memory */
  FLOWDLO_IO = 7,           /* a file could not be read or written */
  FLOWDLO_INTERNAL = 8,     /* a defect of this library; please report it */
  FLOWDLO_OUT_OF_MEMORY = 9 /* the call found no memory; nothing is broken, it may be tried again */
};

/* "ok", "bad_input", ...; "unknown" for what is no status. The text lives as long as the process.
 */
FLOWDLO_EXPORT const char* flowdlo_status_name(flowdlo_status status);

/* What the last failing call of this thread had to say, every fault on a line of its own; empty
 * before the first. Valid until the thread's next failing call, or its end. Cut after 4095 bytes.
 */
FLOWDLO_EXPORT const char* flowdlo_last_error(void);

/* Version of the library that runs, "0.1.0"; FLOWDLO_VERSION is that of the header. */
FLOWDLO_EXPORT const char* flowdlo_version(void);

/* ---- Configuration ---- */

enum { FLOWDLO_QUALITY_FULL = 0, FLOWDLO_QUALITY_FAST = 1, FLOWDLO_QUALITY_AUTO = 2 };
enum { FLOWDLO_PRIOR_OF_WEIGHTS = 0, FLOWDLO_PRIOR_THESIS = 1, FLOWDLO_PRIOR_REFINED = 2 };
enum { FLOWDLO_GATE_OF_WEIGHTS = 0, FLOWDLO_GATE_THESIS = 1, FLOWDLO_GATE_CALIBRATED = 2 };
enum { FLOWDLO_FIELD_BESIDE = 0, FLOWDLO_FIELD_OFF = 1, FLOWDLO_FIELD_STRANDS = 2 };

enum {
  FLOWDLO_FIELD_DEVICE_FASTER = 0, /* a real GPU or the CPU, whichever a trial finds faster */
  FLOWDLO_FIELD_DEVICE_CPU = 1,
  FLOWDLO_FIELD_DEVICE_SAME = 2 /* that of the model, untried */
};

/* flowdlo::Config of <flowdlo/config.hpp>, which says more of each field; the defaults are its. */
typedef struct flowdlo_config {
  size_t struct_size;        /* bytes; flowdlo_config_init */
  const char* weights;       /* a .fdw file; NULL or "": the one that comes with the library */
  const char* device;        /* NULL or "auto", "cpu", "vulkan", part of a name, or a UUID */
  const char* field_weights; /* .safetensors; NULL or "": beside the weights, if there */
  uint64_t seed;             /* same seed, frame and device: the same bits */
  double rope_length_m;      /* of the whole rope, metres; 0: unknown */
  int32_t quality;           /* FLOWDLO_QUALITY_ */
  int32_t euler_steps;       /* 1..64 */
  int32_t draws;             /* 1..64 */
  int32_t prior;             /* FLOWDLO_PRIOR_ */
  int32_t gate;              /* FLOWDLO_GATE_ */
  int32_t field;             /* FLOWDLO_FIELD_ */
  int32_t threads;           /* of the CPU back end; 0: one for each core */
  int32_t max_width;         /* largest frame for which memory is set aside, pixels */
  int32_t max_height;        /* the same */
  int32_t device_timeout_ms; /* 0: chosen by the amount of work */
  int32_t validation;        /* Vulkan's validation layers: 0 or 1; slow */
  int32_t reserved;          /* 0 */
  double budget_ms;          /* that an estimate may take, milliseconds; 0: no limit */
  int32_t probe;             /* 1: Vulkan drivers are asked in processes of their own first */
  int32_t ropes;             /* that flowdlo_estimator_estimate_ropes looks for; 0: all, 1..32 */
  int32_t field_device;      /* FLOWDLO_FIELD_DEVICE_: where the strand field runs */
  int32_t reserved_2;        /* 0 */
} flowdlo_config;

/* Fills `config` with the defaults. `struct_size` is sizeof(flowdlo_config). */
FLOWDLO_EXPORT flowdlo_status flowdlo_config_init(flowdlo_config* config, size_t struct_size);

/* ---- Frames ---- */

enum {
  FLOWDLO_PIXEL_F32 = 1,  /* depth: float, metres; 0 or not finite: none */
  FLOWDLO_PIXEL_U16 = 2,  /* depth: uint16_t, flowdlo_frame.depth_scale_m metres a unit; 0: none */
  FLOWDLO_PIXEL_U8 = 3,   /* mask: uint8_t, the rope where over 127 */
  FLOWDLO_PIXEL_BGR8 = 4, /* colour: three bytes */
  FLOWDLO_PIXEL_RGB8 = 5  /* colour: three bytes */
};

/* An image of the caller's, [height, width], read during a call and never kept. Float depth, masks
 * and BGR without padding are read where they lie; anything else is copied first. */
typedef struct flowdlo_image {
  const void* data;      /* first pixel; NULL: no image */
  ptrdiff_t row_bytes;   /* from a row to the next; 0: rows follow each other; < 0: upwards */
  ptrdiff_t pixel_bytes; /* from a pixel to the next in its row; 0: pixels follow each other */
  int32_t pixel;         /* FLOWDLO_PIXEL_ */
  int32_t reserved;      /* 0 */
} flowdlo_image;

/* One observation. Images are rectified, of one size, and aligned to the pinhole camera fx, fy, cx,
 * cy (pixels; the centre of the top left pixel is (0, 0)). */
typedef struct flowdlo_frame {
  size_t struct_size;   /* bytes; flowdlo_frame_init */
  flowdlo_image depth;  /* FLOWDLO_PIXEL_F32 or FLOWDLO_PIXEL_U16: along z, not along the ray */
  flowdlo_image mask;   /* FLOWDLO_PIXEL_U8 */
  flowdlo_image color;  /* FLOWDLO_PIXEL_BGR8 or FLOWDLO_PIXEL_RGB8; data NULL: not needed */
  double depth_scale_m; /* metres a unit of FLOWDLO_PIXEL_U16, over 0 and at most 1 */
  int32_t width;        /* of the images, pixels */
  int32_t height;       /* of the images, pixels */
  float fx;
  float fy;
  float cx;
  float cy;
  int32_t roi_u;      /* region of interest: column of its top left pixel */
  int32_t roi_v;      /* and row; nothing outside is looked at */
  int32_t roi_width;  /* 0, as roi_height: the whole images. A region is 1..4096 px a side. */
  int32_t roi_height; /* Intrinsics stay those of the whole images, nodes stay where they are. */
  flowdlo_image instances; /* FLOWDLO_PIXEL_U16: which rope each pixel is of, from 1, 0: none or
                            * unknown; data NULL: not known */
} flowdlo_frame;

/* Fills `frame` with zeros, and depth_scale_m with 0.001. `struct_size` is sizeof(flowdlo_frame).
 */
FLOWDLO_EXPORT flowdlo_status flowdlo_frame_init(flowdlo_frame* frame, size_t struct_size);

/* A frame read from disk: depth.png, mask.png, camera.json and, where present, color.png. */
typedef struct flowdlo_frame_folder flowdlo_frame_folder;

/* Fails with FLOWDLO_IO, FLOWDLO_BAD_INPUT or FLOWDLO_OUT_OF_MEMORY, naming the file. */
FLOWDLO_EXPORT flowdlo_status flowdlo_frame_folder_load(const char* path,
                                                        flowdlo_frame_folder** folder);

/* Points `frame`, which flowdlo_frame_init has filled, at the pixels of `folder`, which lives as
 * long as the frame is used. */
FLOWDLO_EXPORT flowdlo_status flowdlo_frame_folder_frame(const flowdlo_frame_folder* folder,
                                                         flowdlo_frame* frame);

FLOWDLO_EXPORT void flowdlo_frame_folder_destroy(flowdlo_frame_folder* folder);

/* The same of a folder whose mask is still to be made: mask.png is not read, the mask is 0. */
FLOWDLO_EXPORT flowdlo_status flowdlo_frame_folder_load_without_mask(const char* path,
                                                                     flowdlo_frame_folder** folder);

/* ---- Masks ---- */

/* The calls of <flowdlo/mask.hpp>, which says more of each field. Each reads the images that it
 * names and no others, which may be missing, and writes `mask_bytes` bytes, 255 where the rope is
 * and 0 elsewhere: [roi_height, roi_width] of the frame's region of interest, [height, width]
 * without one, packed. Other sizes are FLOWDLO_BAD_INPUT. Areas are pixels of an image 640 px wide.
 */

/* The rope's colour as light does not change it. */
typedef struct flowdlo_color_band {
  size_t struct_size; /* bytes; flowdlo_color_band_init */
  uint8_t red;        /* the rope's colour, sRGB */
  uint8_t green;
  uint8_t blue;
  uint8_t smooth;        /* 1: lone pixels go, surrounded ones are filled; 0: not so */
  float tolerance;       /* distance of chromaticities, over 0, at most 2 */
  float least_lightness; /* OKLab's L, 0..1 */
  float most_lightness;  /* the same */
  float fill_holes_px2;  /* holes up to this area are filled, 0..1e6 */
  float least_piece_px2; /* pieces below this area are left out, 0..1e6 */
} flowdlo_color_band;

/* How far above the table the rope may lie. */
typedef struct flowdlo_height_band {
  size_t struct_size;    /* bytes; flowdlo_height_band_init */
  float least_m;         /* metres, over 0 */
  float most_m;          /* metres, over least_m, at most 10 */
  float fill_holes_px2;  /* as in flowdlo_color_band */
  float least_piece_px2; /* as in flowdlo_color_band */
  int32_t smooth;        /* as in flowdlo_color_band */
  int32_t reserved;      /* 0 */
} flowdlo_height_band;

/* How a region grows from the pixels that somebody clicked on. */
typedef struct flowdlo_seed_growth {
  size_t struct_size;        /* bytes; flowdlo_seed_growth_init */
  float tolerance;           /* distance of chromaticities, over 0, at most 2 */
  float lightness_tolerance; /* of OKLab's L, over 0, at most 2 */
  float depth_step_m;        /* metres between neighbours, over 0, at most 10 */
  float fill_holes_px2;      /* as in flowdlo_color_band */
  float least_piece_px2;     /* as in flowdlo_color_band */
  int32_t smooth;            /* as in flowdlo_color_band */
} flowdlo_seed_growth;

/* Fill a struct with the defaults. `struct_size` is sizeof of the struct. */
FLOWDLO_EXPORT flowdlo_status flowdlo_color_band_init(flowdlo_color_band* band, size_t struct_size);
FLOWDLO_EXPORT flowdlo_status flowdlo_height_band_init(flowdlo_height_band* band,
                                                       size_t struct_size);
FLOWDLO_EXPORT flowdlo_status flowdlo_seed_growth_init(flowdlo_seed_growth* growth,
                                                       size_t struct_size);

/* Reads color. */
FLOWDLO_EXPORT flowdlo_status flowdlo_mask_from_color(const flowdlo_frame* frame,
                                                      const flowdlo_color_band* band, uint8_t* mask,
                                                      size_t mask_bytes);

/* Reads depth and intrinsics. `band` NULL: the defaults. */
FLOWDLO_EXPORT flowdlo_status flowdlo_mask_from_plane(const flowdlo_frame* frame,
                                                      const flowdlo_height_band* band,
                                                      uint8_t* mask, size_t mask_bytes);

/* Reads color and, where there is one, depth. `seeds` are `count` pixels of the whole images,
 * [count, 2]: column, row. `growth` NULL: the defaults. */
FLOWDLO_EXPORT flowdlo_status flowdlo_mask_from_seeds(const flowdlo_frame* frame,
                                                      const float* seeds, size_t count,
                                                      const flowdlo_seed_growth* growth,
                                                      uint8_t* mask, size_t mask_bytes);

/* ---- Estimates ---- */

enum { FLOWDLO_SOURCE_PREDICTION = 0, FLOWDLO_SOURCE_PRIOR = 1 };

/* Which of all candidates the nodes are. */
enum {
  FLOWDLO_ORIGIN_FIRST_PRIOR = 0,   /* the prior of the way that explains the frame best */
  FLOWDLO_ORIGIN_RUNNER_UP = 1,     /* the prior of another way through the mask as given */
  FLOWDLO_ORIGIN_OTHER_READING = 2, /* of a way that only a further reading of the mask found */
  FLOWDLO_ORIGIN_FRAME_BEFORE = 3,  /* the rope as it was in the frame before */
  FLOWDLO_ORIGIN_DRAW = 4           /* a draw of the model */
};

/* Why an estimate is not to be trusted: bits of flowdlo_estimate.doubts. */
enum {
  FLOWDLO_DOUBT_NO_ROPE = 1,      /* what the mask shows has not the shape of a rope */
  FLOWDLO_DOUBT_STRANDS_LEFT = 2, /* the nodes leave strands of the mask out */
  FLOWDLO_DOUBT_BARE_GAP = 4,     /* the nodes cross plain background between pieces of the mask */
  FLOWDLO_DOUBT_GOES_ON = 8,      /* depth shows the rope going on where the mask ends */
  FLOWDLO_DOUBT_NO_DEPTH = 16     /* it shows no depth: it is taken to lie on what is beside it */
};

/* What flowdlo_config.budget_ms left no time for: bits of flowdlo_estimate.left_out. */
enum {
  FLOWDLO_LEFT_OUT_MODEL = 1,   /* the model's draws: the estimate is a prior */
  FLOWDLO_LEFT_OUT_FIELD = 2,   /* the strand field: the mask alone was read */
  FLOWDLO_LEFT_OUT_READINGS = 4 /* a closer look or the mask alone, though there was doubt */
};

/* The names that JSON, Python and ROS give to these values: "prior", "runner_up", "no_rope",
 * "strand_field"; "unknown" for what is none of them. flowdlo_doubt_name and flowdlo_left_out_name
 * take one bit. The text lives as long as the process. */
FLOWDLO_EXPORT const char* flowdlo_source_name(int32_t source);
FLOWDLO_EXPORT const char* flowdlo_origin_name(int32_t origin);
FLOWDLO_EXPORT const char* flowdlo_doubt_name(uint32_t doubt);
FLOWDLO_EXPORT const char* flowdlo_left_out_name(uint32_t part);

/* flowdlo::Estimate of <flowdlo/estimate.hpp>, which says more of each field, without the reports
 * of single draws and of the parts of a device's time. */
typedef struct flowdlo_estimate {
  size_t struct_size;             /* bytes; flowdlo_estimate_init */
  float nodes[FLOWDLO_NODES][3];  /* x right, y down, z forward, metres, camera frame, end to end */
  float sigma_m[FLOWDLO_NODES];   /* metres: 68 % of nodes are nearer to the truth than this */
  uint8_t support[FLOWDLO_NODES]; /* 1 where a measured point backs the node, otherwise 0 */
  float confidence;               /* [0, 1] that the nodes are right */
  float mask_agreement;           /* [0, 1] how well the nodes explain the mask */
  float prior_mask_agreement;     /* [0, 1] the same of the prior */
  int32_t source;                 /* FLOWDLO_SOURCE_: where the nodes come from */
  int32_t draw;                   /* index of the returned draw; -1: the prior */
  int32_t calibrated;             /* 1: the calibrated gate decided, 0: that of the thesis */
  int32_t readings;               /* of the frame: strand field, closer, mask alone */
  uint32_t doubts;                /* FLOWDLO_DOUBT_ bits; 0: none */
  int32_t alternatives;           /* how many flowdlo_estimator_alternative has */
  int32_t accepted_draws;         /* draws that the gate found plausible */
  float explained;                /* [0, 1] share of the mask's area near the nodes */
  float slender;                  /* length of the nodes in the image, widths of the rope */
  float sides;                    /* [0, 1] share of the nodes beside which the mask ends */
  float even;                     /* [0, 1] share of these where the mask is as wide as the rope */
  float left_over;                /* length of the strands that the nodes leave out, widths */
  float off_mask;                 /* [0, 1] share of the nodes off the mask, nothing hiding them */
  float bare_gap;                 /* longest stretch of nodes on plain background, widths */
  float goes_on;                  /* how far the rope goes on beyond the mask, widths */
  double evidence_ms;             /* milliseconds of each stage */
  double field_ms;
  double path_ms;
  double prior_ms;
  double readings_ms;
  double mask_field_ms;
  double model_ms;
  double gate_ms;
  double total_ms;
  uint32_t left_out; /* FLOWDLO_LEFT_OUT_ bits; 0: nothing */
  int32_t closed;    /* 1: a ring without ends: node 63 lies where node 0 does */
  int32_t origin;    /* FLOWDLO_ORIGIN_: which of all candidates the nodes are */
  int32_t reserved;  /* 0 */
} flowdlo_estimate;

/* Fills `estimate` with zeros. `struct_size` is sizeof(flowdlo_estimate). */
FLOWDLO_EXPORT flowdlo_status flowdlo_estimate_init(flowdlo_estimate* estimate, size_t struct_size);

/* A traversal of the rope that lost to the returned one. */
typedef struct flowdlo_alternative {
  size_t struct_size;            /* bytes; flowdlo_alternative_init */
  float nodes[FLOWDLO_NODES][3]; /* as flowdlo_estimate.nodes */
  float score;                   /* minus the cost of its path: higher is better, within a frame */
  float mask_agreement;          /* [0, 1] */
} flowdlo_alternative;

/* Fills `alternative` with zeros. `struct_size` is sizeof(flowdlo_alternative). */
FLOWDLO_EXPORT flowdlo_status flowdlo_alternative_init(flowdlo_alternative* alternative,
                                                       size_t struct_size);

/* Owns the device and the weights; made once, called for every frame. */
typedef struct flowdlo_estimator flowdlo_estimator;

/* `config` NULL: the defaults. Its strings are copied. Fails with FLOWDLO_BAD_INPUT,
 * FLOWDLO_BAD_WEIGHTS, FLOWDLO_IO, FLOWDLO_NO_DEVICE, FLOWDLO_DEVICE_LOST or
 * FLOWDLO_OUT_OF_MEMORY. */
FLOWDLO_EXPORT flowdlo_status flowdlo_estimator_create(const flowdlo_config* config,
                                                       flowdlo_estimator** estimator);

FLOWDLO_EXPORT void flowdlo_estimator_destroy(flowdlo_estimator* estimator);

/* Fails with FLOWDLO_BAD_INPUT, FLOWDLO_NO_EVIDENCE, FLOWDLO_NO_PATH, FLOWDLO_DEVICE_LOST or
 * FLOWDLO_OUT_OF_MEMORY. A rejected prediction is not a failure: `source` is then the prior. */
FLOWDLO_EXPORT flowdlo_status flowdlo_estimator_estimate(flowdlo_estimator* estimator,
                                                         const flowdlo_frame* frame,
                                                         flowdlo_estimate* estimate);

/* Alternative `index`, best first, of the estimator's last estimate; none after a failing one. */
FLOWDLO_EXPORT flowdlo_status flowdlo_estimator_alternative(const flowdlo_estimator* estimator,
                                                            int32_t index,
                                                            flowdlo_alternative* alternative);

/* ---- What is known beside the frame ---- */

enum { FLOWDLO_PLACE_NONE = 0, FLOWDLO_PLACE_PIXEL = 1, FLOWDLO_PLACE_POINT = 2 };

/* Where an end of the rope is: a pixel of the whole images, or a point of the camera frame. */
typedef struct flowdlo_place {
  int32_t kind; /* FLOWDLO_PLACE_ */
  float at[3];  /* pixel: column, row, not read; point: x, y, z, metres */
} flowdlo_place;

/* flowdlo::Hints of <flowdlo/hints.hpp>, which says more of each field. */
typedef struct flowdlo_hints {
  size_t struct_size;      /* bytes; flowdlo_hints_init */
  const float* previous;   /* [FLOWDLO_NODES, 3] nodes of the frame before; NULL: none. They keep
                            * the order of the ends, so that a stream can be tracked */
  double rope_length_m;    /* of the whole rope, metres; 0: as flowdlo_config says */
  flowdlo_place first_end; /* the end nearest to it is node 0 */
  flowdlo_place ends[2];   /* where the rope ends, as far as that is known */
  int32_t closed;          /* 1: it is a ring without ends; -1: it has two ends; 0: unknown */
  int32_t reserved;        /* 0 */
} flowdlo_hints;

/* Fills `hints` with nothing known. `struct_size` is sizeof(flowdlo_hints). */
FLOWDLO_EXPORT flowdlo_status flowdlo_hints_init(flowdlo_hints* hints, size_t struct_size);

/* As flowdlo_estimator_estimate, of one rope. `hints` NULL: nothing is known. */
FLOWDLO_EXPORT flowdlo_status flowdlo_estimator_estimate_with_hints(flowdlo_estimator* estimator,
                                                                    const flowdlo_frame* frame,
                                                                    const flowdlo_hints* hints,
                                                                    flowdlo_estimate* estimate);

/* ---- Several ropes ---- */

/* Where one rope passes over another, or over itself. */
typedef struct flowdlo_crossing {
  size_t struct_size; /* bytes; flowdlo_crossing_init */
  int32_t over;       /* index of the rope nearer to the camera */
  int32_t under;      /* and of the other; the same where a rope passes over itself */
  float over_at_m;    /* arclength from node 0 of `over`, metres */
  float under_at_m;   /* arclength from node 0 of `under`, metres */
  float apart_m;      /* by how much the one is nearer than the other along the ray, metres */
  int32_t reserved;   /* 0 */
} flowdlo_crossing;

/* Fills `crossing` with zeros. `struct_size` is sizeof(flowdlo_crossing). */
FLOWDLO_EXPORT flowdlo_status flowdlo_crossing_init(flowdlo_crossing* crossing, size_t struct_size);

/* Estimates each rope of the frame on its own, flowdlo_config.ropes of them, and says how many
 * ropes and crossings there are. `crossings` may be NULL. They stay with the estimator until its
 * next estimate. Fails as flowdlo_estimator_estimate does, and with FLOWDLO_NO_PATH where there are
 * fewer ropes than asked for, or more than 32. */
FLOWDLO_EXPORT flowdlo_status flowdlo_estimator_estimate_ropes(flowdlo_estimator* estimator,
                                                               const flowdlo_frame* frame,
                                                               int32_t* ropes, int32_t* crossings);

/* Rope `index` of the last flowdlo_estimator_estimate_ropes, longest first. */
FLOWDLO_EXPORT flowdlo_status flowdlo_estimator_rope(const flowdlo_estimator* estimator,
                                                     int32_t index, flowdlo_estimate* estimate);

/* Crossing `index` of it. */
FLOWDLO_EXPORT flowdlo_status flowdlo_estimator_crossing(const flowdlo_estimator* estimator,
                                                         int32_t index, flowdlo_crossing* crossing);

/* Which rope each pixel of the mask was given to, from 1; 0: none. Writes [height, width] of the
 * frame, or of its region of interest; `count` is height x width. */
FLOWDLO_EXPORT flowdlo_status flowdlo_estimator_instances(const flowdlo_estimator* estimator,
                                                          uint16_t* instances, size_t count);

/* ---- Streams ---- */

/* flowdlo::TrackerConfig of <flowdlo/tracker.hpp>, which says more of each field. */
typedef struct flowdlo_tracking {
  size_t struct_size;  /* bytes; flowdlo_tracking_init */
  double most_moved_m; /* a rope that moved farther from one frame to the next is another; over 0 */
  int32_t patience;    /* frames that a rope may be missing from and keep its number */
  int32_t reserved;    /* 0 */
} flowdlo_tracking;

/* Fills `tracking` with the library's defaults. `struct_size` is sizeof(flowdlo_tracking). */
FLOWDLO_EXPORT flowdlo_status flowdlo_tracking_init(flowdlo_tracking* tracking, size_t struct_size);

/* From the next tracked frame on. Fails with FLOWDLO_BAD_INPUT, and then changes nothing. */
FLOWDLO_EXPORT flowdlo_status flowdlo_estimator_set_tracking(flowdlo_estimator* estimator,
                                                             const flowdlo_tracking* tracking);

/* The next frame of a stream of one rope: as flowdlo_estimator_estimate_with_hints, where the
 * estimate of the tracked frame before is `previous`, unless `hints` has one. `hints` may be NULL. */
FLOWDLO_EXPORT flowdlo_status flowdlo_estimator_track(flowdlo_estimator* estimator,
                                                      const flowdlo_frame* frame,
                                                      const flowdlo_hints* hints,
                                                      flowdlo_estimate* estimate);

/* The next frame of a stream of several ropes: as flowdlo_estimator_estimate_ropes, but each rope
 * keeps its number and the order of its ends, and flowdlo_estimator_rope hands them out by number.
 * `missing` are ropes that this frame does not show and that are still waited for. `crossings` and
 * `missing` may be NULL. */
FLOWDLO_EXPORT flowdlo_status flowdlo_estimator_track_ropes(flowdlo_estimator* estimator,
                                                            const flowdlo_frame* frame,
                                                            int32_t* ropes, int32_t* crossings,
                                                            int32_t* missing);

/* The number of rope `index` of the last flowdlo_estimator_track_ropes: from 1 in the order of first
 * sight; none is given twice. */
FLOWDLO_EXPORT flowdlo_status flowdlo_estimator_rope_number(const flowdlo_estimator* estimator,
                                                            int32_t index, int32_t* number);

/* The number of missing rope `index` of it. */
FLOWDLO_EXPORT flowdlo_status flowdlo_estimator_missing_rope(const flowdlo_estimator* estimator,
                                                             int32_t index, int32_t* number);

/* Forgets the ropes of the frames before; numbers go on from where they were. */
FLOWDLO_EXPORT flowdlo_status flowdlo_estimator_forget(flowdlo_estimator* estimator);

/* "cpu", or the name of the Vulkan device in use; "" for NULL. Valid until the estimator's next
 * estimate, or its end. */
FLOWDLO_EXPORT const char* flowdlo_estimator_device(const flowdlo_estimator* estimator);

/* The same of the strand field's network; "" where there is none as well. */
FLOWDLO_EXPORT const char* flowdlo_estimator_field_device(const flowdlo_estimator* estimator);

#ifdef __cplusplus
}
#endif
