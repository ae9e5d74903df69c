# SPDX-License-Identifier: Apache-2.0
# What the slots hold after a cut of power, then updates without end, FIRST before SECOND, until the next one. LAST: only the former.
. ./lib.sh
for module in virtio_pci virtio_blk crc32c_generic ext4; do modprobe "$module"; done
until_true test -b /dev/vda
busybox mount -t ext4 /dev/vda /mnt || exit 1
device_up --flash /mnt/flash --slot-kib 128 --erase-ms 150 --rate 1000
for slot in 0 1; do
  rm -f "$scratch/back"
  dfu-util -d 1209:0001 -a $slot -U "$scratch/back" >"$scratch/said" 2>&1
  fact "slot_$slot" "$([ -s "$scratch/back" ] && sha256sum <"$scratch/back" | cut -d' ' -f1 || echo none)"
done
fact looked yes
[ -z "${LAST:-}" ] || exit 0

# Both slots are declared, then one is no more: its new image is being written.
declared() { for at in 0 $((4096 + 128 * 1024)); do dd if=/mnt/flash bs=8 skip=$((at / 8)) count=1 2>/dev/null; done | grep -ao PALPSLOT | wc -l; }
{
  until [ "$(declared)" = 2 ]; do sleep 0.1; done
  while [ "$(declared)" = 2 ]; do sleep 0.02; done
  echo WRITING
} &
while true; do
  for image in "$FIRST" "$SECOND"; do
    echo "FLASHING $image"
    palpate flash "$image.palp" --device usb --verify --quiet
    echo "FLASHED $image $?"
  done
done
