// pbrt scenes, by a parser of their grammar: directives with their arguments, blocks that close,
// parameters of declared types with as many values as they take, names that were made before.
#include "exports/pbrt_scene.h"

#include <cctype>
#include <charconv>
#include <map>
#include <set>

#include "mesh/input_error.h"
#include "radiosity/regular_grid.h"
#include "rich_room.h"
#include "support/catch.h"

using namespace tyndall;

namespace {

using Words = std::vector<std::string>;

// Words; texts keep their opening quote.
Words words_of(const std::string& text) {
    Words words;
    for (std::size_t at = 0; at < text.size();) {
        const char c = text[at];
        if (std::isspace(static_cast<unsigned char>(c))) {
            ++at;
        } else if (c == '#') {
            while (at < text.size() && text[at] != '\n') ++at;
        } else if (c == '"') {
            const auto end = text.find('"', at + 1);
            REQUIRE(end != std::string::npos);
            words.push_back(text.substr(at, end - at));
            at = end + 1;
        } else if (c == '[' || c == ']') {
            words.push_back(std::string(1, c));
            ++at;
        } else {
            const auto begin = at;
            while (at < text.size() && !std::isspace(static_cast<unsigned char>(text[at])) &&
                   text[at] != '[' && text[at] != ']' && text[at] != '"')
                ++at;
            words.push_back(text.substr(begin, at - begin));
        }
    }
    return words;
}

bool is_number(const std::string& word) {
    double value;
    const auto read = std::from_chars(word.data(), word.data() + word.size(), value);
    return read.ec == std::errc() && read.ptr == word.data() + word.size();
}

// How pbrt-v4 reads a directive: texts and numbers that must follow, and whether parameters do.
struct Directive {
    std::size_t texts = 0, numbers = 0;
    bool parameters = false;
    char block = 'b';  // o: before WorldBegin, w: after it, b: both
};
const std::map<std::string, Directive> directives{
    {"Film", {1, 0, true, 'o'}},
    {"PixelFilter", {1, 0, true, 'o'}},
    {"Sampler", {1, 0, true, 'o'}},
    {"Integrator", {1, 0, true, 'o'}},
    {"Camera", {1, 0, true, 'o'}},
    {"WorldBegin", {0, 0, false, 'o'}},
    {"AttributeBegin", {0, 0, false, 'w'}},
    {"AttributeEnd", {0, 0, false, 'w'}},
    {"Shape", {1, 0, true, 'w'}},
    {"LightSource", {1, 0, true, 'w'}},
    {"AreaLightSource", {1, 0, true, 'w'}},
    {"Material", {1, 0, true, 'w'}},
    {"MakeNamedMaterial", {1, 0, true, 'w'}},
    {"NamedMaterial", {1, 0, false, 'w'}},
    {"MakeNamedMedium", {1, 0, true, 'b'}},
    {"MediumInterface", {2, 0, false, 'b'}},
    {"Scale", {0, 3, false, 'b'}},
    {"LookAt", {0, 9, false, 'b'}},
    {"Identity", {0, 0, false, 'b'}},
    {"ConcatTransform", {0, 16, false, 'b'}},
};
// Values of a parameter of each type; 0: any count.
const std::map<std::string, std::size_t> types{{"float", 0}, {"integer", 0}, {"string", 0},
                                               {"bool", 1},  {"rgb", 3},     {"point3", 3}};

class Scene {
  public:
    explicit Scene(const std::string& text) : words_(words_of(text)) {
        while (at_ < words_.size()) directive();
        CHECK(depth_ == 0);
        CHECK(world_);
    }

    std::map<std::string, std::vector<std::map<std::string, Words>>> found;  // parameters
    std::set<std::string> files;

  private:
    std::string next() {
        REQUIRE(at_ < words_.size());
        return words_[at_++];
    }

    void directive() {
        const std::string name = next();
        CAPTURE(name);
        REQUIRE(directives.contains(name));
        const Directive& d = directives.at(name);
        CHECK((d.block == 'b' || (d.block == 'w') == world_));
        Words texts;
        for (std::size_t k = 0; k < d.texts; ++k) {
            texts.push_back(next());
            REQUIRE(texts.back()[0] == '"');
        }
        const bool bracket = d.numbers == 16;
        if (bracket) REQUIRE(next() == "[");
        for (std::size_t k = 0; k < d.numbers; ++k) REQUIRE(is_number(next()));
        if (bracket) REQUIRE(next() == "]");
        std::map<std::string, Words> parameters;
        while (d.parameters && at_ < words_.size() && words_[at_][0] == '"') parameter(parameters);
        if (!texts.empty()) parameters["kind"] = texts;
        meaning(name, parameters);
        found[name].push_back(std::move(parameters));
    }

    void parameter(std::map<std::string, Words>& parameters) {
        const std::string declared = next().substr(1);
        CAPTURE(declared);
        const auto space = declared.find(' ');
        REQUIRE(space != std::string::npos);
        const std::string type = declared.substr(0, space), name = declared.substr(space + 1);
        REQUIRE(types.contains(type));
        Words values;
        if (words_[at_] == "[") {
            for (++at_; words_.at(at_) != "]"; ++at_) values.push_back(words_[at_]);
            ++at_;
        } else {
            values.push_back(next());
        }
        CHECK(!values.empty());
        if (types.at(type) > 0) CHECK(values.size() == types.at(type));
        for (const auto& value : values) {
            if (type == "string")
                CHECK(value[0] == '"');
            else if (type == "bool")
                CHECK((value == "true" || value == "false"));
            else
                CHECK(is_number(value));
        }
        CHECK(parameters.emplace(name, values).second);
    }

    void meaning(const std::string& name, const std::map<std::string, Words>& parameters) {
        if (name == "WorldBegin") world_ = true;
        if (name == "AttributeBegin") ++depth_;
        if (name == "AttributeEnd") CHECK(depth_-- > 0);
        if (name == "MakeNamedMedium") CHECK(media_.insert(parameters.at("kind")[0]).second);
        if (name == "MakeNamedMaterial") CHECK(materials_.insert(parameters.at("kind")[0]).second);
        if (name == "NamedMaterial") CHECK(materials_.contains(parameters.at("kind")[0]));
        if (name == "MediumInterface" && world_)  // a camera's medium is looked up at WorldBegin
            for (const auto& medium : parameters.at("kind"))
                CHECK((medium == "\"" || media_.contains(medium)));
        if (parameters.contains("materials"))
            for (const auto& part : parameters.at("materials")) CHECK(materials_.contains(part));
        if (name == "Shape" && parameters.contains("filename"))
            files.insert(parameters.at("filename")[0].substr(1));
    }

    Words words_;
    std::size_t at_ = 0;
    bool world_ = false;
    int depth_ = 0;
    std::set<std::string> media_, materials_;
};

}  // namespace

TEST_CASE("A scene for pbrt follows its grammar, and all that it names is there", "[export]") {
    const auto enclosure = test::enclosed(test::rich_room());
    const auto camera = test::rich_camera();
    const auto files = exports::pbrt_scene(*enclosure, {&camera, 1}, {.stem = "rich"});
    const Scene scene(files.main);
    std::set<std::string> parts;
    for (const auto& file : files.beside) CHECK(parts.insert(file.name).second);
    CHECK(scene.files == parts);
    // Sky, two suns of which one is a disc, point, spot; both sides of the screen.
    CHECK(scene.found.at("LightSource").size() == 4);
    CHECK(scene.found.at("AreaLightSource").size() == 3);
    for (const auto& light : scene.found.at("AreaLightSource"))
        CHECK(light.at("twosided")[0] == "false");
    CHECK(scene.found.at("MakeNamedMedium").size() == 2);
    const auto& haze = scene.found.at("MakeNamedMedium")[0];
    CHECK(haze.at("sigma_a")[0] == "0.08");
    CHECK(haze.at("sigma_s")[0] == "0.32");
    CHECK(haze.at("g")[0] == "0.7");
    CHECK(files.notes.size() == 2);  // mirrors, the spot's edge
    // The angle across the shorter side: tan 0.6 × 24/32.
    CHECK(std::stod(scene.found.at("Camera")[0].at("fov")[0]) ==
          Approx(2.0 * std::atan(0.75 * std::tan(0.6)) * 180.0 / std::numbers::pi));
}

TEST_CASE("Fog that thins is a grid of densities for pbrt", "[export]") {
    auto room = test::slit_room();
    room.media[0].shape = {
        {std::make_shared<const radiosity::RegularGrid>(
             std::array<std::size_t, 3>{2, 2, 3}, mesh::Point(0, 0, 0), mesh::Point(3, 2, 2),
             std::vector<float>{1, 1, 1, 1, 2, 2, 2, 2, 4, 4, 4, 4}, radiosity::BeyondGrid::edge),
         ""}};
    room.media[0].emission = {1.5};
    const auto camera = test::rich_camera();
    const auto files = exports::pbrt_scene(*test::enclosed(room), {&camera, 1});
    const Scene scene(files.main);
    const auto& medium = scene.found.at("MakeNamedMedium")[0];
    CHECK(medium.at("type")[0] == "\"uniformgrid");
    REQUIRE(medium.at("density").size() == 12);
    CHECK(medium.at("density")[11] == "4");
    // Half a cell beyond the outermost points: values stand in the middle of pbrt's cells.
    CHECK(medium.at("p0") == Words{"-1.5", "-1", "-0.5"});
    CHECK(medium.at("p1") == Words{"4.5", "3", "2.5"});
    CHECK(std::stod(medium.at("sigma_s")[0]) == Approx(0.25 * 0.9));
    CHECK(std::stod(medium.at("Le")[0]) == Approx(1.5));
}

TEST_CASE("What pbrt has no word for is said", "[export]") {
    auto scene = test::slit_room();
    scene.media[0].phase = radiosity::PhaseKind::rayleigh;
    const auto camera = test::rich_camera();
    CHECK_THROWS_WITH(exports::pbrt_scene(*test::enclosed(scene), {&camera, 1}),
                      Contains("Rayleigh") && Contains("--format mitsuba"));
}
