// Checks the figures of run folders against the real Vega-Lite: each <id>.vl.json
//  - is valid by Vega-Lite's JSON schema,
//  - compiles without a warning, and Vega draws it without one,
//  - holds the rows of <id>.csv, and encodes columns that this file has.
//   node check.mjs FOLDER...
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import Ajv from "ajv";
import * as vega from "vega";
import * as vegaLite from "vega-lite";

const require = createRequire(import.meta.url);
const schema = require("vega-lite/build/vega-lite-schema.json");
const valid = new Ajv({ strict: false, validateFormats: false, allErrors: false }).compile(schema);

/** Rows of a CSV file (RFC 4180), the header first. */
function parseCsv(text) {
  const rows = [[]];
  let field = "", quoted = false, ended = true;
  for (let i = 0; i < text.length; ++i) {
    const c = text[i];
    ended = false;
    if (quoted) {
      if (c !== '"') field += c;
      else if (text[i + 1] === '"') field += text[++i];
      else quoted = false;
    } else if (c === '"') {
      quoted = true;
    } else if (c === "," || c === "\n") {
      rows.at(-1).push(field);
      field = "";
      if (c === "\n") { rows.push([]); ended = true; }
    } else {
      field += c;
    }
  }
  assert(ended, "the last line of the CSV file has no end");
  return rows.slice(0, -1);
}

/** A logger that collects warnings and errors; Vega calls its functions as those of other objects. */
function collectingLogger(messages) {
  const logger = { level: () => logger, info: () => logger, debug: () => logger };
  logger.warn = logger.error = (...text) => { messages.push(text.join(" ")); return logger; };
  return logger;
}

/** The fields that encodings name, at any depth. */
function encodedFields(spec) {
  const fields = [];
  const collect = (part, inEncoding) => {
    if (part === null || typeof part !== "object") return;
    if (inEncoding && typeof part.field === "string") fields.push(part.field);
    for (const [key, value] of Object.entries(part)) {
      if (key !== "data") collect(value, inEncoding || key === "encoding" || key === "facet");
    }
  };
  collect(spec, false);
  return fields;
}

/** Number of marks with a place among all items of a scene. */
function countMarks(item) {
  let count = 0;
  for (const child of item.items ?? []) count += countMarks(child);
  const drawn = item.mark?.role === "mark" && Number.isFinite(item.x) && Number.isFinite(item.y);
  return count + (drawn ? 1 : 0);
}

/** Throws for a figure that is not right; says what was drawn. */
export async function check(spec, csv) {
  assert(valid(spec), "schema: " + JSON.stringify(valid.errors?.slice(0, 3)));
  const [header, ...rows] = parseCsv(csv);
  assert.equal(new Set(header).size, header.length, `a column stands twice: ${header}`);
  assert.equal(spec.data.values.length, rows.length, "rows of data");
  rows.forEach((row, i) => {
    const value = spec.data.values[i];
    assert.deepEqual(Object.keys(value), header, `columns of row ${i}`);
    header.forEach((name, c) => {
      assert.equal(value[name] === null ? "" : String(value[name]), numeric(row[c], value[name]), `row ${i}, ${name}`);
    });
  });
  const fields = encodedFields(spec);
  assert(fields.length > 0, "nothing is encoded");
  for (const field of fields) assert(header.includes(field), `the field '${field}' is no column of ${header}`);

  const messages = [], logger = collectingLogger(messages);
  const compiled = vegaLite.compile(spec, { logger }).spec;
  assert.deepEqual(messages, [], "warnings of vegaLite.compile");
  const view = new vega.View(vega.parse(compiled), { renderer: "none", logger });
  await view.runAsync();
  const svg = await view.toSVG();
  const marks = countMarks(view.scenegraph().root);
  view.finalize();
  assert.deepEqual(messages, [], "warnings of Vega");
  assert(!/NaN|undefined/.test(svg), "something is drawn nowhere");
  assert(marks >= Math.min(rows.length, 1), "nothing is drawn");
  return { rows: rows.length, fields, marks };
}

/** The text of a number as JavaScript writes it: both read back to the same double. */
function numeric(text, value) {
  return typeof value === "number" ? String(Number(text)) : text;
}

/** The part of a figure that says mark and encoding; one of its encodings of a field. */
const unit = (spec) => (spec.spec ?? spec).layer?.at(-1) ?? spec.spec ?? spec;
const anEncoding = (spec) => Object.values(unit(spec).encoding).find((channel) => channel.field);

/** The checks find what they are for: mistakes made in a right figure. */
async function checkTheChecks(spec, csv) {
  const broken = {
    "an unknown mark": (s) => { unit(s).mark = "lin"; },
    "an unknown type": (s) => { anEncoding(s).type = "number"; },
    "a field that is no column": (s) => { anEncoding(s).field = "nowhere"; },
    "a missing row": (s) => { s.data.values.pop(); },
    "another value": (s) => { s.data.values[0][Object.keys(s.data.values[0]).at(-1)] = -12345; },
    "a channel without effect": (s) => { unit(s).mark = "rule"; unit(s).encoding.angle = { value: 1 }; },
  };
  for (const [what, make] of Object.entries(broken)) {
    const copy = structuredClone(spec);
    make(copy);
    await assert.rejects(check(copy, csv), `the check does not see ${what}`);
  }
}

let checked = 0;
for (const folder of process.argv.slice(2)) {
  const files = readdirSync(folder, { recursive: true }).filter((name) => name.endsWith(".vl.json")).sort();
  assert(files.length > 0, `${folder} has no figure`);
  for (const file of files) {
    const name = path.join(folder, file);
    try {
      const spec = JSON.parse(readFileSync(name, "utf8"));
      const csv = readFileSync(name.replace(/\.vl\.json$/, ".csv"), "utf8");
      const { rows, fields, marks } = await check(spec, csv);
      console.log(`${name}: ${rows} rows, ${[...new Set(fields)].join(" ")}; ${marks} marks`);
      if (checked++ === 0) await checkTheChecks(spec, csv);
    } catch (error) {
      console.error(`${name}: ${error.message}`);
      process.exitCode = 1;
    }
  }
}
console.log(`${checked} figures checked`);
