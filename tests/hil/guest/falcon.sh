# SPDX-License-Identifier: Apache-2.0
# A Falcon: firmware, homing, a run beside hogs.
. ./lib.sh
modprobe ftdi_sio
device_up --device falcon
head -c 8000 /dev/urandom >"$scratch/firmware"
status without_firmware palpate run "$scene" --device falcon --seconds 0.5 --quiet
status upload palpate run "$scene" --device falcon --firmware "$scratch/firmware" --seconds 0.2 --quiet
hogs_on
measure run --device falcon --rate 1000 --seconds 1
hogs_off
