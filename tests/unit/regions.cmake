# SPDX-License-Identifier: Apache-2.0
palpate_test(regions_kernels SOURCES unit/regions_kernels.cpp LIBS palpate_rt)
