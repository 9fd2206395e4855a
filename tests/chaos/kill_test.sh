#!/bin/sh
# Kills a run again and again at random instants (kill -9, now and then Ctrl-C), resumes it by the same command, and
# compares the bytes of all results with those of a run on one core that nobody disturbed.
#   kill_test.sh RUNNER KILLS CONFIG [NAME:=VALUE...]
set -u
runner="$1" kills="$2"
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "FAILED: $1" >&2
  [ -f "$work/log" ] && cat "$work/log" >&2
  exit 1
}

# Hashes of what must be reproducible; figures over time are not.
results() {
  (cd "$1" && find . -type f ! -name timing.csv ! -name provenance.json ! -name events.jsonl ! -name report.html \
    ! -path '*/.coppice/*' ! -path '*/fig_2_[89]*' -exec cksum {} + | sort -k3)
}
milliseconds() { date +%s%3N; }
acknowledged() { (cd "$1/store/results" 2>/dev/null && find . -name '*.json' | sed 's|.*/||; s|\.json||' | sort); }

start=$(milliseconds)
"$runner" "$@" --out "$work/calm" -j 1 --progress none >"$work/log" 2>&1 || fail "the undisturbed run"
span=$(($(milliseconds) - start))
name=$(basename "$(dirname "$(find "$work/calm" -name resolved.xml)")")
results "$work/calm/$name" >"$work/expected"
[ -s "$work/expected" ] || fail "no results"

killed=0 round=0
while [ "$killed" -lt "$kills" ]; do
  round=$((round + 1)) attempt=0
  out="$work/round"
  rm -rf "$out"
  while :; do
    attempt=$((attempt + 1))
    acknowledged "$out" >"$work/before"
    [ -s "$work/before" ] || echo "no result yet" >"$work/before"
    lines=$(cat "$out/$name/events.jsonl" 2>/dev/null | wc -l)
    "$runner" "$@" --out "$out" -j 2 --progress none >"$work/log" 2>&1 &
    process=$!
    random=$(od -An -N4 -tu4 /dev/urandom | tr -d ' ')
    # Somewhat longer with every attempt, so that the longest node is done some day.
    wait_ms=$((random % (span * (4 + attempt) / 8 + 1)))
    sleep "$((wait_ms / 1000)).$(printf %03d $((wait_ms % 1000)))"
    signal=KILL
    [ $((random / 65536 % 3)) -eq 0 ] && signal=INT
    if kill -$signal "$process" 2>/dev/null; then killed=$((killed + 1)); fi
    wait "$process" 2>/dev/null
    status=$?
    acknowledged "$out" >"$work/after"
    lost=$(comm -23 "$work/before" "$work/after" | grep -v "no result yet")
    [ -z "$lost" ] || fail "results were acknowledged and are lost: $lost"
    again=$(tail -n +"$((lines + 1))" "$out/$name/events.jsonl" 2>/dev/null | grep '"started"' | grep -F -f "$work/before")
    [ -z "$again" ] || fail "computed again, although it was acknowledged: $again"
    [ "$status" -eq 0 ] && break
    [ "$status" -eq 137 ] || [ "$status" -eq 3 ] || fail "exit status $status after SIG$signal at $wait_ms ms"
  done
  results "$out/$name" >"$work/found"
  diff "$work/expected" "$work/found" || fail "other bytes in round $round, after $attempt attempts"
  leftovers=$(find "$out" -name '*.tmp'; find "$out/store/tmp" "$out/store/checkpoints" -mindepth 1 ! -name lock;
    ls "$out/$name/.coppice/unrecorded" 2>/dev/null)
  [ -z "$leftovers" ] || fail "left behind: $leftovers"
  again=$("$runner" "$@" --out "$out" -j 2 2>&1 >/dev/null)
  case "$again" in *"up to date"*) ;; *) fail "not up to date after all: $again" ;; esac
done
echo "killed $killed times in $round rounds; an undisturbed run takes $span ms"
