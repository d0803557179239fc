#include <new>
#include <vector>

#include "cli/commands.h"
#include "mesh/input_error.h"
#include "support/catch.h"

namespace {

using namespace tyndall::cli;

// A shell with one command, which does `action`.
int run(const std::vector<const char*>& words, const Action& action) {
    Shell shell;
    const Command command = shell.add_command("do", "Something", "  tyndall do", action);
    add_seed_flag(command, shell.flags());
    add_set_flag(command, shell.flags());
    std::vector<const char*> arguments{"tyndall", "do"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    return shell.run(static_cast<int>(arguments.size()), arguments.data());
}

}  // namespace

TEST_CASE("common flags reach the command") {
    CommonFlags seen;
    const auto keep = [&](const CommonFlags& flags) {
        seen = flags;
        return 0;
    };
    CHECK(run({"--threads", "2", "--seed", "18446744073709551615", "--quiet", "--json", "--set",
               "camera.main.eye=[1, 2, 3]", "--set", "title=a = b"},
              keep) == 0);
    CHECK(seen.threads == 2);
    CHECK(seen.seed == 18446744073709551615ull);
    CHECK(seen.quiet);
    CHECK(seen.json);
    REQUIRE(seen.settings.size() == 2);
    CHECK(seen.settings[0].key == "camera.main.eye");
    CHECK(seen.settings[0].value == "[1, 2, 3]");
    CHECK(seen.settings[1].key == "title");
    CHECK(seen.settings[1].value == "a = b");
    CHECK(run({}, keep) == 0);
    CHECK(seen.threads == 0);
    CHECK_FALSE(seen.seed);
    CHECK(run({"--set", "a="}, keep) == 0);
    CHECK(seen.settings.at(0).value.empty());
}

TEST_CASE("wrong flags are wrong usage, and the command is not run") {
    bool ran = false;
    const auto action = [&](const CommonFlags&) {
        ran = true;
        return 0;
    };
    CHECK(run({"--set", "no_equals_sign"}, action) == 2);
    CHECK(run({"--set", "=value"}, action) == 2);
    CHECK(run({"--seed", "-1"}, action) == 2);
    CHECK(run({"--threads"}, action) == 2);
    CHECK(run({"left over"}, action) == 2);
    CHECK_FALSE(ran);
}

TEST_CASE("whatever a command throws is a failure with exit code 1") {
    CHECK(run({}, [](const CommonFlags&) { return 1; }) == 1);
    CHECK(run({}, [](const CommonFlags&) -> int { throw tyndall::mesh::InputError("bad"); }) == 1);
    CHECK(run({}, [](const CommonFlags&) -> int { throw std::runtime_error("bad"); }) == 1);
    CHECK(run({}, [](const CommonFlags&) -> int { throw std::bad_alloc(); }) == 1);
    CHECK(run({}, [](const CommonFlags&) -> int { throw 1; }) == 1);
}
