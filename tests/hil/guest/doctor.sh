# SPDX-License-Identifier: Apache-2.0
. ./lib.sh
fact kernel "$(uname -r)"
THREADS=ordinary device_up
json before palpate doctor --json
[ "$BUS" = real ] || fix
json after palpate doctor --json
hogs_on
fact cyclictest_us "$(cyclictest -q -m ${CPU:+-a "$CPU"} -p 95 -i 1000 -l 1000 -t 1 | sed -n 's/.*Max: *//p')"
hogs_off
