// Executes exported policies and compares them with what the program itself did: <name>.states holds float32 rows of
// states, <name>.actions float64 rows of its actions.
//  - <name>.json, evaluated here as docs/exports.md says, gives the same bits;
//  - <name>.onnx, executed by ONNX Runtime, the same up to the rounding of single precision.
//   node check.mjs FOLDER
import assert from "node:assert/strict";
import { readFileSync, readdirSync, existsSync } from "node:fs";
import path from "node:path";
import * as ort from "onnxruntime-web";

ort.env.wasm.numThreads = 1;
ort.env.logLevel = "error";

const clamp = (value, low, high) => (value < low ? low : high < value ? high : value);
const sum = (values) => values.reduce((total, value) => total + value, 0);

/** Moves a value into an axis's range. */
function inside(value, axis) {
  const low = axis.low ?? -Infinity, high = axis.high ?? Infinity;
  if (Number.isNaN(value)) return Number.isFinite(low + high) ? low / 2 + high / 2 : clamp(0, low, high);
  if (value >= low && value <= high) return value;
  if (axis.circular && Number.isFinite(value) && low < high) value -= (high - low) * Math.floor((value - low) / (high - low));
  return clamp(value, low, high);
}

/** The inputs, then the directions: what splits go by. */
function features(model, x) {
  const all = [...x], rows = model.directions ?? [], width = x.length + 1;
  for (let at = 0; at < rows.length; at += width)
    all.push(x.reduce((value, xi, i) => value + rows[at + 1 + i] * xi, rows[at]));
  return all;
}

function leafOf(tree, x) {
  let node = 0;
  while (tree.child[node] !== 0) node = tree.child[node] + (x[tree.index[node]] > tree.value[node] ? 1 : 0);
  return node;
}

function forest(model, output, x) {
  const count = output.trees.length, width = model.inputs + 3;
  const splitBy = features(model, x);
  const leaves = output.trees.map((tree) => leafOf(tree, splitBy));
  let mean;
  if (model.leaves === "constant") {
    const values = leaves.map((leaf, i) => output.trees[i].value[leaf]);
    mean = model.trimmed === null ? sum(values) / count : trimmedMean(values, model.trimmed);
    return output.offset + output.scale * mean;
  }
  const rows = leaves.map((leaf, i) => {
    const first = output.trees[i].index[leaf] * width;
    return output.trees[i].models.slice(first, first + width);
  });
  const values = rows.map((row) => x.reduce((value, xi, i) => value + row[1 + i] * xi, row[0]));
  const lows = rows.map((row) => row[width - 2]), highs = rows.map((row) => row[width - 1]);
  if (model.trimmed === null) return clamp(sum(values), sum(lows), sum(highs)) / count;
  return trimmedMean(values.map((value, i) => clamp(value, lows[i], highs[i])), model.trimmed);
}

function trimmedMean(values, cut) {
  const all = sum(values), left = values.length - 2 * cut;
  if (Number.isNaN(all)) return NaN;
  if (cut === 0) return all / left;
  const sorted = [...values].sort((a, b) => a - b);
  const low = sorted[cut - 1], high = sorted[values.length - cut];
  if (low === high) return low;
  const between = sum((cut > 6 ? sorted : values).map((value) => (value > low && value < high ? value : 0)));
  const lows = values.filter((value) => value <= low).length - cut;
  const highs = values.filter((value) => value >= high).length - cut;
  return (between + lows * low + highs * high) / left;
}

/** The function's outputs at x. */
function evaluate(model, x) {
  if (model.kind === "constant") return model.values;
  if (model.kind === "forest") return model.outputs.map((output) => forest(model, output, x));
  return model.bias.map((bias, o) => {
    const slopes = model.slopes.slice(o * x.length, (o + 1) * x.length);
    const products = slopes.map((slope, i) => slope * x[i]);
    return model.bias_last ? bias + sum(products) : products.reduce((value, product) => value + product, bias);
  });
}

function numbers(file, type) {
  const bytes = readFileSync(file);
  return new type(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
}

/** Largest difference by output, on circular axes along the circle, and the outputs' largest size. */
function differences(actual, expected, axes) {
  const worst = axes.map(() => 0), size = axes.map(() => 1);
  expected.forEach((value, i) => {
    const o = i % axes.length, axis = axes[o];
    let difference = Math.abs(actual[i] - value);
    if (axis.circular) difference = Math.min(difference, Math.abs(axis.high - axis.low - difference));
    assert(!Number.isNaN(difference), `row ${Math.floor(i / axes.length)}, output ${o}: ${actual[i]} for ${value}`);
    worst[o] = Math.max(worst[o], difference);
    size[o] = Math.max(size[o], Math.abs(value));
  });
  return { worst, size };
}

const folder = process.argv[2];
let inNode = 0, inRuntime = 0;
for (const file of readdirSync(folder).filter((name) => name.endsWith(".json")).sort()) {
  const base = path.join(folder, file.replace(/\.json$/, ""));
  const policy = JSON.parse(readFileSync(base + ".json", "utf8"));
  const states = numbers(base + ".states", Float32Array), expected = numbers(base + ".actions", Float64Array);
  const columns = policy.states.length, axes = policy.action.axes, rows = states.length / columns;
  assert.equal(expected.length, rows * axes.length);
  for (let row = 0; row < rows; ++row) {
    const x = Array.from(states.subarray(row * columns, (row + 1) * columns));
    evaluate(policy.function, x).forEach((value, o) => {
      const action = inside(value, axes[o]);
      assert(Object.is(action, expected[row * axes.length + o]), `${file}, row ${row}: ${action} for ${expected[row * axes.length + o]}`);
    });
  }
  ++inNode;
  if (!existsSync(base + ".onnx")) continue;
  const session = await ort.InferenceSession.create(readFileSync(base + ".onnx"));
  const { action } = await session.run({ state: new ort.Tensor("float32", states, [rows, columns]) });
  assert.deepEqual(Array.from(action.dims), [rows, axes.length]);
  const { worst, size } = differences(action.data, expected, axes);
  worst.forEach((difference, o) =>
    assert(difference <= 4e-6 * size[o], `${base}.onnx, output ${o}: differs by ${difference}, values up to ${size[o]}`));
  console.log(`${file}: ONNX Runtime differs by ${worst.map((d) => d.toExponential(1))}`);
  ++inRuntime;
}
console.log(`${inNode} in Node.js, ${inRuntime} in ONNX Runtime`);
