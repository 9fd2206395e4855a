#!/bin/sh
# Ten thousand nodes: planned in less than a second, and an up-to-date run of them, too.
#   scale_test.sh RUNNER
set -eu
runner="$1"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat >"$work/scale.xml" <<'XML'
<experiment coppice="1" name="scale" doc="Ten thousand nodes.">
  <problem id="plant"><double_integrator/></problem>
  <policy id="any"><random/></policy>
  <sweep id="s"><grid><param name="i" values="${range(1, 3334, 1)}"/></grid></sweep>
  <collect id="samples" over="s" problem="plant" policy="any" episodes="1" horizon="2"/>
  <train id="learned" over="s" problem="plant" samples="samples">
    <fqi iterations="1"><q_value><extra_trees trees="1"/></q_value></fqi>
  </train>
  <evaluate id="scores" over="s" problem="plant" policies="learned" episodes="1" horizon="2"/>
</experiment>
XML
# Least time of three, in ms: others may use the machine.
least() {
  best=100000
  for _ in 1 2 3; do
    start=$(date +%s%3N)
    "$@" >"$work/log" 2>&1
    took=$(($(date +%s%3N) - start))
    [ "$took" -lt "$best" ] && best=$took
  done
  echo "$best"
}
planned=$(least "$runner" plan "$work/scale.xml" --out "$work/out")
grep -q "10002 of 10002 nodes to run" "$work/log"
"$runner" "$work/scale.xml" --out "$work/out" --progress none >/dev/null
again=$(least "$runner" "$work/scale.xml" --out "$work/out")
grep -q "up to date: 10002 nodes" "$work/log"
echo "planned in $planned ms, up to date in $again ms"
[ "$planned" -lt 1000 ] && [ "$again" -lt 1000 ]
