// Help where people stand: examples that are true, completion that a real shell takes, a manual
// that man reads, and messages that say what to type instead.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "cli/commands.h"
#include "cli/completion.h"
#include "cli/manual.h"
#include "cli/scene_templates.h"
#include "support/catch.h"
#include "support/program.h"

namespace {

using namespace tyndall;
namespace fs = std::filesystem;

cli::ProgramDescription description() {
    cli::Shell shell;
    cli::add_all_commands(shell);
    return shell.description();
}

// The words of an example's first command, as a shell would part them: no example has quotes.
std::vector<std::string> words_of(const std::string& line) {
    std::istringstream in(line);
    std::vector<std::string> words;
    for (std::string word; in >> word && word != ">" && word != "||" && word != "|";)
        words.push_back(word);
    return words;
}

std::vector<std::string> all_examples() {
    const auto program = description();
    auto examples = program.examples;
    for (const auto& command : program.commands)
        examples.insert(examples.end(), command.examples.begin(), command.examples.end());
    return examples;
}

// The template "room", to be solved in a second: what the examples speak of, as they were run.
struct HelpWorkplace : test::Workplace {
    HelpWorkplace() : test::Workplace("help") {}

    void make_room() const {
        good("new room -o room.toml --quiet");
        auto text = read("room.toml");
        const auto replace = [&](const std::string& what, const std::string& by) {
            const auto at = text.find(what);
            REQUIRE(at != std::string::npos);
            text.replace(at, what.size(), by);
        };
        replace("width = 480", "width = 24");
        replace("height = 360", "height = 18");
        // [solve] is the template's last table.
        write("room.toml", text +
                               "max_elements = 3000\nelement_size = 2.0\nrays = 16\n"
                               "gather_rays = 16\n\n[render]\nsamples = 1\n");
    }
};

bool there_is(const char* program) {
    return std::system(("command -v " + std::string(program) + " >/dev/null 2>&1").c_str()) == 0;
}

}  // namespace

TEST_CASE("every command has examples, and every example is understood") {
    const auto program = description();
    CHECK(program.examples.size() >= 3);
    for (const auto& command : program.commands) {
        CAPTURE(command.name);
        CHECK_FALSE(command.examples.empty());
        CHECK_FALSE(command.purpose.empty());
        for (const auto& option : command.options) {
            CAPTURE(option.names.front());
            CHECK_FALSE(option.help.empty());
        }
    }
    for (const auto& example : all_examples()) {
        CAPTURE(example);
        const auto words = words_of(cli::example_of(example).line);
        REQUIRE(words.size() >= 2);
        CHECK(words.front() == "tyndall");
        cli::Shell shell;
        cli::add_all_commands(shell);
        CHECK(shell.trouble({words.begin() + 1, words.end()}) == "");
    }
    cli::Shell shell;
    cli::add_all_commands(shell);
    CHECK(shell.trouble({"run", "room.toml", "--outptu", "out/"}) != "");
}

TEST_CASE("examples of the room do what they say, one after the other", "[long]") {
    const HelpWorkplace place;
    place.make_room();
    place.good("run room.toml -o out/ --quiet");
    place.good("run room.toml -o fine/ --quiet");
    fs::copy(place.path / "fine", place.path / "before");
    place.write("points.csv", "x,y,z\n2.5,2,1\n");
    place.write("walls.csv", "x,y,z,nx,ny,nz\n2.5,2,0,0,0,1\n");
    place.good("render out/ -o reference.pfm --quiet");
    place.good("render out/ -o direct.pfm --layer direct_single --quiet");
    std::size_t ran = 0;
    for (const auto& example : all_examples()) {
        const auto line = cli::example_of(example).line;
        const auto words = words_of(line);
        const std::string command = words.at(1);
        // What is about other scenes, or takes long by its nature, is parsed above.
        if (command == "study" || command == "animate" || command == "new") continue;
        if (line.find("--region") != line.npos || line.find("--crop") != line.npos) continue;
        std::string arguments;
        for (std::size_t k = 1; k < words.size(); ++k) arguments += words[k] + " ";
        if (line.find("path_traced") != line.npos) arguments += "--time 0.1 ";
        if (command == "exchange") arguments += "--rays 16 --set solve.resolution=16 ";
        if (line.find("width") != line.npos) continue;
        CAPTURE(line);
        const auto outcome = place.run(arguments);
        // "… || echo worse": to fail is what it is for.
        const bool judges = line.find("||") != line.npos;
        if (!judges) CHECK(outcome.err.find("tyndall: ") == std::string::npos);
        CHECK(outcome.code <= (judges ? 1 : 0));
        ++ran;
    }
    CHECK(ran >= 20);
}

TEST_CASE("what is missing is said with a line to type") {
    const HelpWorkplace place;
    const auto output = place.run("run room.toml");
    CHECK(output.code == 2);
    CHECK_THAT(output.err,
               Contains("--output is required") && Contains("tyndall run room.toml -o"));
    CHECK_THAT(place.run("run room.toml out/").err, Contains("Did you mean -o out/?"));
    CHECK_THAT(place.run("check").err, Contains("SCENE is required"));
    CHECK_THAT(place.run("run room.toml -o").err, Contains("--output needs a value (DIR)"));
    CHECK_THAT(place.run("run room.toml -o out/ --method walked").err,
               Contains("unknown flag '--method'") && Contains("render") && Contains("exchange"));
    const auto scene = place.run("room.toml");
    CHECK(scene.code == 2);
    CHECK_THAT(scene.err, Contains("tyndall run room.toml -o room/"));
    fs::create_directories(place.path / "out");
    CHECK_THAT(place.run("out").err, Contains("tyndall view out"));
}

TEST_CASE("files of another kind are told what they are, and what takes them") {
    const HelpWorkplace place;
    place.good("new room -o room.toml --quiet");
    place.write("study.toml", "scene = \"room.toml\"\n[axes]\n\"solve.error\" = [0.1]\n");
    place.write("picture.png", std::string("\x89PNG\r\n\x1a\n", 8));
    place.write("solution.vtkhdf", std::string("\x89HDF\r\n\x1a\n", 8));
    const auto says = [&](const std::string& arguments, const std::string& words) {
        CAPTURE(arguments);
        const auto outcome = place.run(arguments);
        CHECK(outcome.code == 1);
        test::check_one_message(outcome);
        CHECK_THAT(outcome.err, Contains(words));
    };
    says("run romm.toml -o out/", "Did you mean room.toml?");
    says("run none.png -o out/", "tyndall new room");
    says("check .", "room.toml");
    says("check study.toml", "tyndall study study.toml -o study/");
    says("run solution.vtkhdf -o out/", "tyndall view solution.vtkhdf");
    says("run picture.png -o out/", "a picture, not a scene");
    says("study room.toml -o s/", "tyndall run room.toml");
    says("view room.toml", "Solve it first: tyndall run room.toml");
    says("render study.toml -o a.png", "a study, not a solution");
    says("render picture.png -o a.png", "a picture, not a solution");
    says("check room.toml --set eror=0.1", "Did you mean \"solve.error\"?");
}

TEST_CASE("new writes what checks, never over what is there") {
    const HelpWorkplace place;
    CHECK_THAT(place.good("new --list"), Contains("room") && Contains("furnace"));
    for (const auto& scene : cli::scene_templates()) {
        const std::string name(scene.name);
        CAPTURE(name);
        CHECK_THAT(place.good("new " + name), Contains("wrote    " + name + ".toml"));
        const auto text = place.read(name + ".toml");
        CHECK(text.find('@') == std::string::npos);
        // Says its units, and how it is run.
        CHECK_THAT(text, Contains("[m]") || Contains("[K]"));
        CHECK_THAT(text, Contains(name + ".toml -o out/"));
        CHECK_THAT(place.good("check --no-forecast " + name + ".toml"), Contains("sound"));
        CHECK(place.run("new " + name).code == 1);
        place.good("new --force " + name);
    }
    place.write("mine.toml", "mine");
    CHECK_THAT(place.run("new -o mine.toml").err, Contains("is there already"));
    CHECK(place.read("mine.toml") == "mine");
    place.write("fog.obj", "mine");
    CHECK(place.run("new model -o fog.toml").code == 1);
    CHECK(place.read("fog.obj") == "mine");
    CHECK_FALSE(place.has("fog.toml"));
    CHECK_THAT(place.run("new rom").err, Contains("Did you mean \"room\"?"));
    CHECK_THAT(place.run("new room -o room.txt").err, Contains("room.toml"));
    place.good("new model -o 'a b/c \"d\".toml'");
    place.good("check --no-forecast 'a b/c \"d\".toml'");
}

TEST_CASE("every template is solved", "[long]") {
    const HelpWorkplace place;
    for (const auto& scene : cli::scene_templates()) {
        const std::string name(scene.name);
        CAPTURE(name);
        place.good("new --quiet " + name);
        place.good("solve " + name + ".toml -o " + name +
                   " --quiet --set solve.element_size=1 --set solve.max_elements=4000 --set "
                   "solve.rays=16 --set solve.gather_rays=16 --set solve.error=0.5");
        CHECK(place.has(name + "/solution.vtkhdf"));
    }
}

TEST_CASE("bash completes commands, flags, names, files and keys") {
    if (!there_is("bash")) return;
    const HelpWorkplace place;
    place.good("new room -o room.toml --quiet");
    fs::create_directories(place.path / "results");
    place.write("notes.txt", "");
    // Completes the words that are given, the last of them, as bash does.
    place.write("complete.sh", R"~(PATH="$1:$PATH"; shift
source <(tyndall completion bash)
COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1))
_tyndall
printf '%s\n' "${COMPREPLY[@]}"
)~");
    const auto complete = [&](const std::string& words) {
        const std::string bin = fs::path(test::program).parent_path().string();
        const std::string line = "cd '" + place.path.string() + "' && bash complete.sh '" + bin +
                                 "' tyndall " + words + " >done.txt 2>err.txt";
        CHECK(std::system(line.c_str()) == 0);
        CHECK(place.read("err.txt") == "");
        return "\n" + place.read("done.txt");
    };
    CHECK_THAT(complete("ru"), Contains("\nrun\n"));
    CHECK_THAT(complete("''"), Contains("\nrun\n") && Contains("\nview\n") && Contains("\nhelp\n"));
    CHECK_THAT(complete("help an"), Contains("\nanimate\n"));
    CHECK_THAT(complete("run --re"), Contains("\n--resume\n") && Contains("\n--replay\n"));
    const auto scenes = complete("run ''");
    CHECK_THAT(scenes, Contains("\nroom.toml\n") && Contains("\nresults\n"));
    CHECK(scenes.find("notes.txt") == std::string::npos);
    CHECK_THAT(complete("run room.toml -o re"), Contains("\nresults\n"));
    CHECK_THAT(complete("render results --method two"), Contains("\ntwo_pass\n"));
    CHECK_THAT(complete("render results --method = pa"), Contains("\npath_traced\n"));
    CHECK_THAT(complete("exchange room.toml --method hemi"), Contains("\nhemicube\n"));
    CHECK_THAT(complete("new fu"), Contains("\nfurnace\n"));
    CHECK_THAT(complete("check room.toml --set solve.er"), Contains("\nsolve.error=\n"));
    CHECK_THAT(complete("check room.toml --set medium.haze.ext"),
               Contains("\nmedium.haze.extinction=\n"));
    CHECK(complete("check --threads ''") == "\n\n");
    // The second place of compare, behind a flag with its value.
    CHECK_THAT(complete("compare --layer beauty results re"), Contains("\nresults\n"));
}

TEST_CASE("zsh and fish take their scripts") {
    const HelpWorkplace place;
    const auto runs = [&](const std::string& line) {
        CAPTURE(line);
        return std::system(("cd '" + place.path.string() + "' && PATH='" +
                            fs::path(test::program).parent_path().string() + "':$PATH " + line)
                               .c_str()) == 0;
    };
    place.write("_tyndall", place.good("completion zsh"));
    place.write("tyndall.fish", place.good("completion fish"));
    // Everything that the program knows is in them.
    const auto program = description();
    const auto zsh = place.read("_tyndall"), fish = place.read("tyndall.fish");
    for (const auto& command : program.commands)
        for (const auto& option : command.options)
            for (const auto& name : option.names) {
                if (option.positional) continue;
                CAPTURE(command.name, name);
                CHECK(zsh.find(name) != std::string::npos);
                CHECK(fish.find((name.starts_with("--") ? " -l " : " -s ") +
                                name.substr(name.starts_with("--") ? 2 : 1)) != std::string::npos);
            }
    if (there_is("zsh")) CHECK(runs("zsh -n _tyndall"));
    if (!there_is("fish")) return;
    const auto complete = [&](const std::string& words) {
        CHECK(runs("fish -N -c 'source tyndall.fish; complete -C \"tyndall " + words +
                   "\"' >done.txt 2>err.txt"));
        return place.read("done.txt");
    };
    CHECK_THAT(complete("ru"), Contains("run\t"));
    CHECK_THAT(complete("render out --method two"), Contains("two_pass"));
    CHECK_THAT(complete("run --res"), Contains("--resume"));
}

TEST_CASE("the manual is one that man reads without a warning") {
    const HelpWorkplace place;
    const auto text = place.good("man");
    place.write("tyndall.1", text);
    for (const char c : text) REQUIRE((static_cast<unsigned char>(c) < 0x80));
    for (const auto& command : description().commands) {
        CAPTURE(command.name);
        CHECK(text.find(".SS " + command.name + "\n") != std::string::npos);
    }
    CHECK_THAT(text, Contains("\\-\\-output") && Contains("EXIT STATUS"));
    if (!there_is("groff")) return;
    const auto line = "cd '" + place.path.string() +
                      "' && groff -man -ww -z -Tascii tyndall.1 >warnings.txt 2>&1";
    CHECK(std::system(line.c_str()) == 0);
    CHECK(place.read("warnings.txt") == "");
}

TEST_CASE("keys that --set takes are those of the readers") {
    const auto keys = cli::settable_keys();
    CHECK(std::find(keys.begin(), keys.end(), "solve.error") != keys.end());
    CHECK(std::find(keys.begin(), keys.end(), "render.samples") != keys.end());
    const HelpWorkplace place;
    place.good("new room -o room.toml --quiet");
    const auto named = cli::settable_keys(place.path / "room.toml");
    for (const auto* key : {"material.plaster.reflectance", "surface.table.box",
                            "light.sun.sun.irradiance", "camera.main.width"}) {
        CAPTURE(key);
        CHECK(std::find(named.begin(), named.end(), key) != named.end());
    }
    // A file that is being written is none yet.
    place.write("half.toml", "[[material]\nname = ");
    CHECK(cli::settable_keys(place.path / "half.toml") == keys);
}
