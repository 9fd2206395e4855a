#include "engine/config/experiment.h"

namespace coppice {
namespace {

using Attributes = std::vector<std::pair<std::string, std::string>>;

const std::vector<std::string> kSweepParts = {"param", "grid", "zip", "list", "random", "sobol"};

std::vector<ControlElement> make_structure() {
  return {
      {"experiment",
       "A config file: definitions, sweeps and the nodes of the experiment.",
       {{"coppice!", "Version of the language: 1."},
        {"name",
         "Name of the experiment and of its output folder; default: the file's name without its extension."},
        {"seed", "Root of all randomness, 0 to 2^64 - 1; default 1."},
        {"doc", "What the experiment is for."}},
       {"*"},
       {}},
      {"include",
       "Puts in the content of another config; its definitions become those of this one.",
       {{"file!", "The file, relative to the one that names it."}},
       {"arg"},
       {}},
      {"arg",
       "Passes a value to an argument that the included file declares.",
       {{"name!", "The argument."}, {"value!", "Its value."}},
       {},
       {"include"}},
      {"arg",
       "Declares an argument, which the command line can set: name:=value.",
       {{"name!", "Its name."},
        {"default", "Its value when none is given; without one, the command line must give it."},
        {"type", "number, integer, boolean, text or list; default: whatever the value looks like."},
        {"values", "The values allowed, separated by commas."},
        {"unit",
         "Unit of the number: the value has this dimension, and without a unit of its own this unit."},
        {"doc", "What it is for."}},
       {},
       {}},
      {"let",
       "Names a value, once and for all.",
       {{"name!", "Its name."}, {"value!", "Its value."}, {"doc", "What it is for."}},
       {},
       {}},
      {"macro",
       "Elements to be put in by <call>, with parameters.",
       {{"name!", "Its name."},
        {"params", "Parameters, separated by commas: a (required), b:=1 (with default), *c (elements)."},
        {"doc", "What it is for."}},
       {"*"},
       {}},
      {"call",
       "Puts in the elements of a macro; further attributes are its arguments, the content is its block.",
       {{"macro!", "The macro."}, {"*", "An argument of the macro."}},
       {"*"},
       {}},
      {"insert",
       "Inside a macro: puts in the elements that the call gives.",
       {{"block!", "The parameter."}},
       {},
       {}},
      {"group", "Holds elements together, to give them one condition.", {}, {"*"}, {}},
  };
}

std::vector<ControlElement> make_sweeps() {
  std::vector<std::string> sweep_parts = {"grid", "zip", "list", "random", "sobol", "exclude"};
  const Attributes drawn = {
      {"name!", "Name of the column."},
      {"values", "Values to choose from, separated by commas (instead of min and max)."},
      {"min", "Smallest value."},
      {"max", "Largest value."},
      {"log", "true: uniform in the logarithm; default false."},
      {"integer", "true: integers, max included; default false."}};
  return {
      {"sweep",
       "Points that nodes run over: the union of its parts.",
       {{"id!", "Its name, for over=."}, {"seed_label", "Label of the draws of <random>; default 'sweep'."}},
       sweep_parts,
       {}},
      {"grid",
       "Every combination of its parts, the last one changing fastest.",
       {},
       kSweepParts,
       {"sweep", "grid", "zip"}},
      {"zip",
       "The points of its parts side by side; all have the same number.",
       {},
       kSweepParts,
       {"sweep", "grid", "zip"}},
      {"list", "Points given one by one.", {}, {"point"}, {"sweep", "grid", "zip"}},
      {"random",
       "Points drawn from the experiment's seed; more points leave the first ones as they are.",
       {{"n!", "Number of points."}},
       {"param"},
       {"sweep", "grid", "zip"}},
      {"sobol",
       "The first points of the Sobol' sequence, which covers the box evenly.",
       {{"n!", "Number of points."}},
       {"param"},
       {"sweep", "grid", "zip"}},
      {"point", "One point of a list.", {{"*", "The value of a column."}}, {}, {"list"}},
      {"param",
       "A column of a sweep and its values.",
       {{"name!", "Name of the column."}, {"values!", "Its values, separated by commas."}},
       {},
       {"grid", "zip"}},
      {"param",
       "A column of a sweep and the range or the values that it is drawn from.",
       drawn,
       {},
       {"random", "sobol"}},
      {"exclude",
       "Leaves out points.",
       {{"when!", "A condition on the columns: ${a == 1 and b gt 2}."}},
       {},
       {"sweep"}},
  };
}

}  // namespace

bool is_control_attribute(std::string_view name) {
  return name == "if" || name == "unless";
}

const std::vector<ControlElement>& control_elements() {
  static const std::vector<ControlElement> kElements = [] {
    std::vector<ControlElement> all = make_structure();
    for (ControlElement& element : make_sweeps()) all.push_back(std::move(element));
    return all;
  }();
  return kElements;
}

}  // namespace coppice
