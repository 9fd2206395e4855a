#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/config/value.h"
#include "registry/source.h"

namespace coppice::config {

/// What a name stands for, and where that was said.
struct Definition {
  Value value = Value::boolean(false);
  Place place;
  std::string what;     ///< "argument", "constant", "parameter of macro 'm'"
  bool failed = false;  ///< its value could not be worked out, and that was reported
};

/// The values of sweep columns at one point.
struct ColumnValue {
  const std::string* name = nullptr;
  const Value* value = nullptr;
};
using ColumnValues = std::vector<ColumnValue>;

/// Names and their definitions, which never change. The global scope belongs to the experiment; each macro
/// call and each node has one of its own inside it.
class Scope {
 public:
  /// `columns`, if any, are known here beside the definitions.
  explicit Scope(std::shared_ptr<const Scope> outer = nullptr, const ColumnValues* columns = nullptr)
      : outer_(std::move(outer)), columns_(columns) {}

  struct Found {
    const Value* value = nullptr;  ///< null when there is none
    bool failed = false;           ///< defined, but without a value after a mistake
  };
  /// The nearest meaning of a name, here or further out.
  Found find(std::string_view name) const;
  /// Null when nothing is defined under this name here; columns do not count.
  const Definition* find_here(std::string_view name) const;
  /// The nearest definition before `limit` is reached, going out from here.
  const Definition* find_before(const Scope& limit, std::string_view name) const;
  void define(const std::string& name, Definition definition) { own_.emplace(name, std::move(definition)); }
  std::vector<std::string> names() const;  ///< here and further out

 private:
  std::shared_ptr<const Scope> outer_;
  const ColumnValues* columns_;
  std::map<std::string, Definition, std::less<>> own_;
};

/// What <include> passes to the arguments of a file.
struct PassedArguments {
  std::map<std::string, Attribute, std::less<>> values;
  std::map<std::string, Place, std::less<>> names;  ///< where each stands
  std::set<std::string> taken;                      ///< of `values`, those that an <arg> declared
  std::vector<std::string> declared;                ///< every argument declared while the file was expanded
  PassedArguments* outer = nullptr;
};

struct MacroFrame;

/// The <call> and <insert> elements by which expansion came somewhere. Includes play no part: what a file
/// says is the same by whichever include it is met.
struct Way {
  const Element* through = nullptr;
  std::shared_ptr<const Way> outer;
};

/// Where expansion is: what names mean, how it came here, what may stand here.
struct Context {
  std::shared_ptr<Scope> scope;
  const ColumnValues* columns = nullptr;    ///< of the node that is being expanded
  std::shared_ptr<const MacroFrame> macro;  ///< the call whose body this is; null outside of macros
  std::shared_ptr<const TraceFrame> trace;
  std::shared_ptr<const Way> way;
  PassedArguments* passed = nullptr;  ///< by the <include> whose file this is
  bool inside = false;                ///< in a node or a sweep, where nothing global can be defined
  bool names_unknown = false;  ///< a mistake hides which names there are: unknown ones are not reported
  int depth = 0;               ///< of macro calls and includes within each other
};

/// A call of a macro while its body is expanded: the blocks that <insert> puts in, to be read where the call
/// stands.
struct MacroFrame {
  std::string macro;
  std::map<std::string, std::vector<const Element*>, std::less<>> blocks;
  Context caller;
};

}  // namespace coppice::config
