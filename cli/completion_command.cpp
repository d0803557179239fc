#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/completion.h"
#include "cli/suggestion.h"
#include "mesh/input_error.h"

namespace tyndall::cli {
namespace {

struct CompletionOptions {
    std::string shell, scene;
};

int complete(const CompletionOptions& options, const ProgramDescription& program) {
    const std::vector<std::string> shells{"bash", "zsh", "fish", "keys"};
    std::string text;
    if (options.shell == "bash")
        text = bash_completion(program);
    else if (options.shell == "zsh")
        text = zsh_completion(program);
    else if (options.shell == "fish")
        text = fish_completion(program);
    else if (options.shell == "keys")
        for (const auto& key : settable_keys(options.scene)) text += key + "\n";
    else
        throw mesh::InputError(fmt::format("there is no completion for \"{}\". {}", options.shell,
                                           suggest(options.shell, shells)));
    write_output(text);
    return 0;
}

}  // namespace

void add_completion_command(Shell& shell) {
    const auto options = std::make_shared<CompletionOptions>();
    auto command = shell.add_command(
        "completion", "A script by which a shell completes commands, flags, files and keys",
        R"(  tyndall completion bash > tyndall.bash       then: source tyndall.bash
  tyndall completion zsh > _tyndall            into a folder of $fpath
  tyndall completion fish > tyndall.fish       into fish's folder for completions
  tyndall completion keys room.toml            what --set takes)",
        [options, &shell](const CommonFlags&) { return complete(*options, shell.description()); });
    command.option("SHELL", options->shell, "bash, zsh or fish; keys: the keys that --set takes")
        .required()
        .word_of({"bash", "zsh", "fish", "keys"});
    command.option("SCENE", options->scene, "With keys: a scene whose names they have")
        .file({"toml"});
}

}  // namespace tyndall::cli
