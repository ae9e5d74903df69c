# SPDX-License-Identifier: Apache-2.0
# The loop without a bus, and cyclictest beside it.
. ./lib.sh
measure_beside_hogs at_1k --rate 1000 --seconds 1
cyclictest -q -m -p 90 -i 1000 -D 1 -t 1 >"$scratch/cyclictest" & cyclictest=$!
measure_beside_hogs at_4k --rate 4000 --seconds 0.8
wait $cyclictest
fact cyclictest_us "$(sed -n 's/.*Max: *//p' "$scratch/cyclictest")"
