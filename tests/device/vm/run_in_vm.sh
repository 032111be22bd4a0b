#!/usr/bin/env bash
# run_in_vm.sh PROGRAM FOLDER [ARG...]: boots Debian's kernel in an emulated machine that holds little but PROGRAM, runs
# it there as root with its ARGs, and ends as it ended. FOLDER keeps the kernel for the next time.
#
# HAPTEL_VM_SECONDS (60) is how long each exchange with a device goes on. Ends with 77, and why, where the machine or
# the kernel cannot be had. The emulator is slow, but it needs no rights: /dev/kvm is not used.
set -euo pipefail

program=$1 folder=$2
shift 2
seconds=${HAPTEL_VM_SECONDS:-60}
modules=(usb-common usbcore usbip-core vhci-hcd hid usbhid hid-generic evdev uinput)

skip() { printf 'run_in_vm.sh: skipped. %s\n' "$*" >&2; exit 77; }

[[ $(uname -m) == x86_64 ]] || skip "The emulated machine is an x86_64, and this one a $(uname -m)"
for tool in qemu-system-x86_64:qemu-system-x86 busybox:busybox-static cpio:cpio; do
    command -v "${tool%:*}" >/dev/null || skip "There is no ${tool%:*}: apt-get install ${tool#*:}"
done

# The one that the package linux-image-amd64 depends on, unpacked as far as it is needed.
get_kernel() {
    local package
    package=$(apt-cache depends linux-image-amd64 2>/dev/null |
        sed -nE 's/^ *Depends: (linux-image-[0-9].*)/\1/p' | head -n 1)
    [[ -n $package ]] || skip "Expected Debian, whose package linux-image-amd64 apt knows; found none: apt-get update"
    rm -rf "$folder/part"
    mkdir -p "$folder/part"
    (cd "$folder/part" && apt-get download "$package") || skip "$package cannot be downloaded"
    dpkg-deb --fsys-tarfile "$folder"/part/*.deb | tar -x -C "$folder/part" --wildcards './boot/vmlinuz-*' \
        './*/kernel/drivers/usb/*' './*/kernel/drivers/hid/*' './*/kernel/drivers/input/*'
    rm "$folder"/part/*.deb
    mv "$folder/part" "$folder/kernel"
}

[[ -d $folder/kernel ]] || get_kernel
image=$(echo "$folder"/kernel/boot/vmlinuz-*)
version=${image##*/vmlinuz-}

# What the machine holds: one file system in memory.
inside=$(mktemp -d)
chmod 755 "$inside" # of the root of what it holds
trap 'rm -rf "$inside"' EXIT
mkdir -p "$inside"/{bin,dev,proc,sys,tmp,"lib/modules/$version"}
cp "$(command -v busybox)" "$inside/bin/busybox"
for module in "${modules[@]}"; do
    file=$(find "$folder/kernel" -name "$module.ko*")
    [[ -n $file ]] || skip "The kernel $version has no module $module"
    case $file in
    *.xz) xz -dc "$file" >"$inside/lib/modules/$version/$module.ko" ;;
    *) cp "$file" "$inside/lib/modules/$version/" ;;
    esac
done
busybox depmod -b "$inside" "$version"
strip -o "$inside/program" "$program"
ldd "$program" | grep -oE '/[^ ]+' | while read -r library; do
    mkdir -p "$inside${library%/*}"
    cp -L "$library" "$inside$library"
done
{
    printf '#!/bin/busybox sh\n'
    printf '/bin/busybox --install -s /bin\n'
    printf 'mount -t proc none /proc; mount -t sysfs none /sys; mount -t devtmpfs none /dev\n'
    printf 'for module in %s; do modprobe "$module" || echo "no module $module"; done\n' "${modules[*]}"
    printf 'export HAPTEL_VM_SECONDS=%q HAPTEL_CACHE=off\n' "$seconds"
    printf 'dmesg -c >/dev/null\n/program'
    (($# == 0)) || printf ' %q' "$@"
    printf '\nended=$?\n[ $ended = 0 ] || [ $ended = 77 ] || dmesg\necho "the program ended with $ended"\npoweroff -f\n'
} >"$inside/init"
chmod +x "$inside/init"
(cd "$inside" && find . | cpio --quiet -o -H newc) | gzip -1 >"$folder/inside.gz"

# One processor: the emulator is slower with two, and with what guards against processors that speculate. Its clock
# counts instructions, a nanosecond each, and skips what it would sleep: what runs there is as fast as on any machine,
# however busy this one is. Three exchanges, and a machine that is slow.
timeout $((5 * ${seconds%.*} + 300)) qemu-system-x86_64 -accel tcg -icount shift=0,sleep=off -rtc clock=vm -machine q35 \
    -cpu max -smp 1 -m 512 -display none -nodefaults -serial stdio -no-reboot -kernel "$image" -initrd "$folder/inside.gz" \
    -append 'console=ttyS0 loglevel=1 panic=-1 mitigations=off' </dev/null |
    sed -u 's,\x1b\[[0-9;]*m,,g; s,\r,,g' | tee "$folder/log" || true
ended=$(sed -nE 's/^the program ended with ([0-9]+)$/\1/p' "$folder/log")
[[ -n $ended ]] || { echo "run_in_vm.sh: the machine stopped before the program ended: see above" >&2; exit 1; }
exit "$ended"
