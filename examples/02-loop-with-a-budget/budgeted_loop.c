/* SPDX-License-Identifier: Apache-2.0 */
/* budgeted_loop IMAGE [SECONDS]: a loop at 1 kHz in which no query takes longer than 300 us. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "rt_core/palpate.h"

enum { kPeriod_ns = 1000000, kBudget_ns = 300000, kTicksPerSecond = 1000 };

static uint64_t now_ns(void* unused) {
  struct timespec now;
  (void)unused;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

static void sleep_until(uint64_t ns) {
  const struct timespec when = {(time_t)(ns / 1000000000u), (long)(ns % 1000000000u)};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &when, 0);
}

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

int main(int count, char** arguments) {
  if (count < 2) return fprintf(stderr, "usage: budgeted_loop IMAGE [SECONDS]\n"), 2;
  const long ticks = count > 2 ? (long)(kTicksPerSecond * atof(arguments[2])) : kTicksPerSecond;
  size_t size = 0;
  void* bytes = read_file(arguments[1], &size);
  palpate_image images[2];
  const palpate_status opened = palpate_open(bytes, size, &images[0]);
  if (opened) return fprintf(stderr, "%s: %s\n", arguments[1], palpate_describe(opened)), 3;
  images[1] = images[0];

  const palpate_pair pairs[] = {{0, 1}};
  const palpate_scene scene = {images, 2, pairs, 1, 0};
  palpate_settings settings;
  palpate_limits limits;
  palpate_default_settings(&settings);
  palpate_default_limits(&limits);
  settings.engine = PALPATE_REGIONS;
  settings.delta_m = 0.0005;
  settings.max_force_N = 3;
  const size_t need = up_to_64(palpate_required_bytes(&scene, &limits, settings.engine));
  void* memory = aligned_alloc(64, need);
  palpate_engine* engine = 0;
  const palpate_status made = palpate_create(&scene, &settings, &limits, memory, need, &engine);
  if (made) return fprintf(stderr, "engine: %s\n", palpate_describe(made)), 1;

  long cut = 0, late = 0;
  double most_N = 0;
  const uint64_t start = now_ns(0);
  for (long i = 0; i < ticks; ++i) {
    const uint64_t due = start + (uint64_t)i * kPeriod_ns;
    sleep_until(due);
    /* In place of a device: the tool goes down and up, twice a second. They touch at 16 mm. */
    const double height_m = 0.0165 - 0.001 * sin(6.2832 * 2 * (double)i / kTicksPerSecond);
    const palpate_pose poses[2] = {{{0, 0, height_m}, {1, 0, 0, 0}}, {{0, 0, 0}, {1, 0, 0, 0}}};
    /* From now, not from when it was due: a late tick gets its time, and is counted. */
    const palpate_budget budget = {UINT64_MAX, now_ns, 0, now_ns(0) + kBudget_ns, 0, 0};
    palpate_result result;
    if (palpate_tick(engine, poses, &budget, &result)) return 1;
    cut += result.truncated_by_time != 0;
    if (result.force_N[2] > most_N) most_N = result.force_N[2];
    late += now_ns(0) > due + kPeriod_ns;
  }
  printf("%ld ticks, %ld cut short by the budget, %ld late; force at most %.3f N\n", ticks, cut,
         late, most_N);
  free(memory);
  free(bytes);
  return 0;
}
