# SPDX-License-Identifier: Apache-2.0
# A Falcon: firmware, homing, a run beside hogs.
. ./lib.sh
modprobe ftdi_sio
device_up --device falcon
head -c 8000 /dev/urandom >"$scratch/firmware"
status without_firmware "${render[@]}" --seconds 0.5
status upload "${render[@]}" --firmware "$scratch/firmware" --seconds 0.2
measure_beside_hogs run --rate 1000 --seconds 1
