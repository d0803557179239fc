// Programs as children: what they return, say and cost, and that they can be stopped.
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "cli/child_process.h"
#include "mesh/input_error.h"
#include "support/catch.h"

using tyndall::cli::run_child;
namespace fs = std::filesystem;

namespace {

const fs::path messages =
    fs::temp_directory_path() / ("tyndall_messages_" + std::to_string(::getpid()));
const auto go_on = [] { return true; };

tyndall::cli::ChildOutcome shell(const std::string& script) {
    return run_child("/bin/sh", {"-c", script}, messages, go_on);
}

}  // namespace

TEST_CASE("A child's exit code, its signal and what it says are told") {
    CHECK(shell("exit 0").exit_code == 0);
    CHECK(shell("exit 7").exit_code == 7);
    const auto killed = shell("echo too large >&2; kill -9 $$");
    CHECK(killed.exit_code == -1);
    CHECK(killed.signal == SIGKILL);
    std::ostringstream said;
    said << std::ifstream(messages).rdbuf();
    CHECK(said.str() == "too large\n");
    CHECK(shell("read line").exit_code != 0);  // there is nothing to read
    fs::remove(messages);
}

TEST_CASE("A child's costs are its own, with those of its children") {
    const auto busy = shell("i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done; (exit 0)");
    CHECK(busy.cpu_seconds > 0.01);
    CHECK(busy.wall_seconds >= 0.5 * busy.cpu_seconds);
    CHECK(busy.peak_memory_bytes > 100'000);
    fs::remove(messages);
}

TEST_CASE("A child is stopped when it is asked to") {
    const auto began = std::chrono::steady_clock::now();
    const auto outcome = run_child("/bin/sleep", {"60"}, messages, [] { return false; });
    CHECK(outcome.stop_was_asked);
    CHECK(outcome.signal == SIGTERM);
    CHECK(std::chrono::steady_clock::now() - began < std::chrono::seconds(30));
    fs::remove(messages);
}

TEST_CASE("A program that is not there, and messages that cannot be written, are refused") {
    CHECK_THROWS_AS(run_child("/nowhere/program", {}, messages, go_on), tyndall::mesh::InputError);
    CHECK_THROWS_AS(run_child("/bin/sh", {}, "/nowhere/messages", go_on),
                    tyndall::mesh::InputError);
    fs::remove(messages);
}
