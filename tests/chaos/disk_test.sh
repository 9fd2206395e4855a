#!/bin/sh
# A full disk and a read-only one: a clear message that names file and reason, nothing lost, and the same command goes
# on when there is room again. Needs the right to mount; without it, there is nothing to test (status 77).
#   disk_test.sh RUNNER CONFIG
set -u
runner="$1" config="$2"
work=$(mktemp -d)
disk="$work/disk"
mkdir "$disk"
cleanup() {
  umount "$disk" 2>/dev/null
  rm -rf "$work"
}
trap cleanup EXIT
mount -t tmpfs -o size=400k tmpfs "$disk" 2>/dev/null || exit 77
fail() {
  echo "FAILED: $1" >&2
  cat "$work/log" >&2
  exit 1
}
run() { "$runner" "$config" --out "$disk/out" -j 2 --progress plain >"$work/log" 2>&1; }

run
status=$?
[ "$status" -eq 1 ] || [ "$status" -eq 2 ] || fail "exit status $status on a full disk"
grep -q "$disk/.*: No space left on device" "$work/log" || fail "the message does not name the file and the reason"
mount -o remount,size=64m "$disk" || exit 77
run || fail "with room again"
"$runner" "$config" --out "$work/other" --progress none >/dev/null 2>&1
diff -r "$work/other/chaos/tables" "$disk/out/chaos/tables" >"$work/log" || fail "other results after a full disk"

if mount -o remount,ro "$disk" 2>/dev/null; then
  "$runner" "$config" --out "$disk/new" >"$work/log" 2>&1
  [ $? -eq 2 ] || fail "a read-only output folder is a mistake of the user"
  grep -q "$disk/new.*Read-only file system" "$work/log" || fail "the message does not name the folder and the reason"
fi
echo "nothing is lost on a full disk"
