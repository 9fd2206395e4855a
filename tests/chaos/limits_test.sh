#!/bin/sh
# Limits of nodes: the message says limit and use, other nodes go on, and a raised limit goes on from the checkpoint.
#   limits_test.sh RUNNER
set -u
runner="$1"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  echo "FAILED: $1" >&2
  cat "$work/log" >&2
  exit 1
}
config() {
  cat <<XML
<experiment coppice="1" name="limits">
  <problem id="plant"><double_integrator/></problem>
  <policy id="any"><random/></policy>
  <policy id="still"><constant/></policy>
  <collect id="samples" problem="plant" policy="any" episodes="$1" horizon="50" memory_limit="$2"/>
  <collect id="few" problem="plant" policy="any" episodes="20" horizon="50"/>
  <train id="learned" problem="plant" samples="few" time_limit="$3"><fqi iterations="$4"/></train>
  <evaluate id="scores" problem="plant" policies="still" episodes="20"/>
</experiment>
XML
}
run() { "$runner" "$work/limits.xml" --out "$work/out" -j 2 >"$work/log" 2>&1; }

config 20 "1 GB" "0.7 s" 100000 >"$work/limits.xml"
run && fail "a training of 100000 iterations kept its time limit"
grep -q "learned.*time_limit of 0.7 s, after" "$work/log" || fail "no message about the time limit"
[ -f "$work/out/limits/nodes/scores/still/evaluation.csv" ] || fail "the other nodes did not go on"

# One unit of work that takes far longer than its limit, and offers no place to stop before its end.
cat >"$work/unit.xml" <<XML
<experiment coppice="1" name="unit">
  <problem id="plant"><double_integrator/></problem>
  <collect id="samples" problem="plant" samples="200000"/>
  <train id="learned" problem="plant" samples="samples" time_limit="0.2 s">
    <fqi iterations="1"><q_value><extra_trees trees="500"/></q_value></fqi>
  </train>
</experiment>
XML
"$runner" "$work/unit.xml" --out "$work/unit" >"$work/log" 2>&1 && fail "a node far over its time limit counts as done"
grep -q "learned.*time_limit of 0.2 s, after" "$work/log" || fail "no message about the time limit of one unit"

config 21 "10 kB" "1 h" 30 >"$work/limits.xml"
run && fail "a program fits into 10 kB"
grep -q "samples.*memory_limit is 10 kB; it had" "$work/log" || fail "no message about a tiny memory limit"

config 20 "1 GB" "1 h" 100000 >"$work/limits.xml"
"$runner" "$work/limits.xml" --out "$work/out" --progress none >"$work/log" 2>&1 &
sleep 2
kill -INT $!
wait $!
[ $? -eq 3 ] || fail "Ctrl-C did not end a run whose node has a process of its own"

config 20 "1 GB" "1 h" 30 >"$work/limits.xml"
run || fail "a node within its limits failed"
config 20 "1 GB" "2 h" 30 >"$work/limits.xml"
run || fail "another limit"
grep -q "up to date" "$work/log" || fail "a limit is no parameter of the result"

config 300000 "60 MB" "1 h" 30 >"$work/limits.xml"
run && fail "15 million transitions fit into 60 MB"
grep -q "samples.*memory_limit is 60 MB; it had" "$work/log" || fail "no message about the memory limit"
echo "limits are kept and told"
