#include "engine/cli/command.h"
#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"

namespace coppice::cli {
namespace {

// Each script hands the words up to the cursor to `runner __complete`, which knows all commands, components
// and the arguments of the configs on the line. A last line ":config", ":file" or ":folder" asks for the
// shell's own files.

constexpr const char* kBash = R"(# bash completion for runner
_runner() {
  local line="${COMP_LINE:0:COMP_POINT}" words=() replies=() reply cur trimmed="" files=""
  read -ra words <<< "$line"
  [[ "$line" == *[[:space:]] ]] && words+=("")
  cur="${words[-1]}"
  COMPREPLY=()
  mapfile -t replies < <("${words[0]}" __complete "${words[@]:1}" 2> /dev/null)
  for reply in "${replies[@]}"; do
    case "$reply" in
      :*) files="$reply" ;;
      *) COMPREPLY+=("$reply") ;;
    esac
  done
  case "$files" in
    :config) mapfile -O "${#COMPREPLY[@]}" -t COMPREPLY < <(compgen -f -X '!*.xml' -- "$cur"; compgen -d -- "$cur") ;;
    :file) mapfile -O "${#COMPREPLY[@]}" -t COMPREPLY < <(compgen -f -- "$cur") ;;
    :folder) mapfile -O "${#COMPREPLY[@]}" -t COMPREPLY < <(compgen -d -- "$cur") ;;
  esac
  [[ -n "$files" ]] && compopt -o filenames
  [[ "${COMPREPLY[*]}" == *:= ]] && compopt -o nospace
  # bash replaces only what follows the last word break; ':' and '=' are such.
  if [[ "$cur" == *[:=]* && "$COMP_WORDBREAKS" == *:* ]]; then
    trimmed="${cur%"${cur##*[:=]}"}"
    COMPREPLY=("${COMPREPLY[@]#"$trimmed"}")
  fi
}
complete -F _runner runner
)";

constexpr const char* kZsh = R"(#compdef runner
# zsh completion for runner
_runner() {
  local -a replies plain open
  local reply files=""
  replies=("${(@f)$("${words[1]}" __complete "${(@)words[2,CURRENT]}" 2> /dev/null)}")
  for reply in "${replies[@]}"; do
    case "$reply" in
      :*) files="$reply" ;;
      *:=) open+=("$reply") ;;
      ?*) plain+=("$reply") ;;
    esac
  done
  (( ${#plain} )) && compadd -- "${plain[@]}"
  (( ${#open} )) && compadd -S '' -- "${open[@]}"
  case "$files" in
    :config) _files -g '*.xml' ;;
    :file) _files ;;
    :folder) _files -/ ;;
  esac
  return 0
}
compdef _runner runner
)";

constexpr const char* kFish = R"(# fish completion for runner
function __runner_complete
  set -l before (commandline -opc)
  set -l current (commandline -ct)
  for reply in ($before[1] __complete $before[2..-1] "$current" 2> /dev/null)
    switch $reply
      case ':config' ':file'
        __fish_complete_path "$current"
      case ':folder'
        __fish_complete_directories "$current"
      case '*'
        echo $reply
    end
  end
end
complete -c runner -f -a '(__runner_complete)'
)";

struct Completion {
  std::string shell;

  static Arguments<Completion> arguments() {
    return Arguments<Completion>().choice("SHELL", &Completion::shell, {"bash", "zsh", "fish"},
                                          "Your shell.");
  }

  int run(const CommandLine&, Console& console) const {
    console.out(shell == "bash" ? kBash : shell == "zsh" ? kZsh : kFish);
    return kDone;
  }
};

const Command<Completion> kCompletion(
    {.name = "completion",
     .group = Group::project,
     .doc =
         "Writes the script that lets a shell complete commands, options, components and config arguments.",
     .examples = {{"source <(runner completion bash)", "For this bash; put it into ~/.bashrc to keep it."},
                  {"runner completion zsh > ~/.zfunc/_runner", "For zsh, where ~/.zfunc is in fpath."},
                  {"runner completion fish > ~/.config/fish/completions/runner.fish", "For fish."}}});

}  // namespace
}  // namespace coppice::cli
