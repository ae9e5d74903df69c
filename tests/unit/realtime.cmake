# SPDX-License-Identifier: GPL-3.0-or-later
palpate_test(realtime_test
  SOURCES
    unit/realtime_histogram.cpp unit/realtime_safety.cpp unit/realtime_loop.cpp
    unit/realtime_wall.cpp unit/realtime_trace.cpp unit/realtime_thread.cpp
    unit/realtime_host_checks.cpp
  LIBS palpate_tools)
