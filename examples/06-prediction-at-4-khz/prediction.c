/* SPDX-License-Identifier: Apache-2.0 */
/* prediction IMAGE: contacts at 1 kHz, a force at 4 kHz. Counted in periods, not timed: it shows
 * what the force in between is worth. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "rt_core/palpate.h"

enum { kPredictions = 4, kPeriods = 2000 };

static size_t up_to_64(size_t bytes) { return (bytes + 63) / 64 * 64; }

/* The whole file on a 64-byte boundary; null where it cannot be read. */
static void* read_file(const char* path, size_t* size) {
  FILE* file = fopen(path, "rb");
  if (!file) return 0;
  fseek(file, 0, SEEK_END);
  *size = (size_t)ftell(file);
  rewind(file);
  void* bytes = aligned_alloc(64, up_to_64(*size + 1));
  if (bytes && fread(bytes, 1, *size, file) != *size) {
    free(bytes);
    bytes = 0;
  }
  fclose(file);
  return bytes;
}

/* Where the tool is in a period of the fast loop: down, along, up. They touch at 16 mm. */
static palpate_pose tool_at(int period) {
  const double s = (double)period / kPeriods;
  const palpate_pose pose = {{0.004 * s, 0, 0.0163 - 0.0008 * sin(3.14159265 * s)}, {1, 0, 0, 0}};
  return pose;
}

static palpate_engine* engine_of(const palpate_image* images, void** memory) {
  static const palpate_pair pairs[] = {{0, 1}};
  const palpate_scene scene = {images, 2, pairs, 1, 0};
  palpate_settings settings;
  palpate_limits limits;
  palpate_default_settings(&settings);
  palpate_default_limits(&limits);
  settings.engine = PALPATE_REGIONS;
  settings.delta_m = 0.0005;
  settings.exact = 1;
  const size_t need = up_to_64(palpate_required_bytes(&scene, &limits, settings.engine));
  palpate_engine* engine = 0;
  *memory = aligned_alloc(64, need);
  return palpate_create(&scene, &settings, &limits, *memory, need, &engine) ? 0 : engine;
}

int main(int count, char** arguments) {
  if (count != 2) return fprintf(stderr, "usage: prediction IMAGE\n"), 2;
  size_t size = 0;
  void* bytes = read_file(arguments[1], &size);
  palpate_image images[2];
  const palpate_status opened = palpate_open(bytes, size, &images[0]);
  if (opened) return fprintf(stderr, "%s: %s\n", arguments[1], palpate_describe(opened)), 3;
  images[1] = images[0];
  void *slow_memory = 0, *fast_memory = 0;
  palpate_engine* slow = engine_of(images, &slow_memory); /* asked every fourth period */
  palpate_engine* fast = engine_of(images, &fast_memory); /* asked every period: the truth */
  if (!slow || !fast) return 1;

  const palpate_budget all = {UINT64_MAX, 0, 0, 0, 0, 0};
  double held_error = 0, predicted_error = 0, most = 0;
  palpate_result held, truth;
  for (int period = 0; period < kPeriods; ++period) {
    const palpate_pose poses[2] = {tool_at(period), {{0, 0, 0}, {1, 0, 0, 0}}};
    if (palpate_tick(fast, poses, &all, &truth)) return 1;
    if (period % kPredictions == 0 && palpate_tick(slow, poses, &all, &held)) return 1;
    double force_N[3], torque_Nm[3];
    if (palpate_predict(slow, &poses[0], force_N, torque_Nm)) return 1;
    held_error = fmax(held_error, fabs(held.force_N[2] - truth.force_N[2]));
    predicted_error = fmax(predicted_error, fabs(force_N[2] - truth.force_N[2]));
    most = fmax(most, truth.force_N[2]);
  }
  printf("force at most %.4f N; off by at most %.4f N held, %.4f N predicted\n", most, held_error,
         predicted_error);
  free(fast_memory);
  free(slow_memory);
  free(bytes);
  return predicted_error <= held_error ? 0 : 1;
}
