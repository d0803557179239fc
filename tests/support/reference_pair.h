// Scenes of two things whose exchange area is known: polygons, boxes, tetrahedra of the reference
// figures.
#pragma once

#include <numeric>

#include "radiosity/exchange_table.h"
#include "support/reference.h"
#include "support/rooms.h"

namespace tyndall::test {

using Corners = std::vector<mesh::Point>;

inline mesh::Point point_of(const nlohmann::json& p) {
    return {p[0], p[1], p[2]};
}

inline Corners corners_of(const nlohmann::json& list) {
    Corners corners;
    for (const auto& p : list) corners.push_back(point_of(p));
    return corners;
}

// [[x0, x1], [y0, y1], [z0, z1]] with one interval of no length.
inline Corners rectangle_of(const nlohmann::json& r) {
    const mesh::Point low(r[0][0], r[1][0], r[2][0]), high(r[0][1], r[1][1], r[2][1]);
    int flat = 0;
    while (high[flat] > low[flat]) ++flat;
    const int u = (flat + 1) % 3, v = (flat + 2) % 3;
    Corners corners(4, low);
    corners[1][u] = corners[2][u] = high[u];
    corners[2][v] = corners[3][v] = high[v];
    return corners;
}

// A scene of two things in one medium that fills everything, each under its own name.
class ReferencePair {
  public:
    explicit ReferencePair(double extinction) : extinction_(extinction) {
        scene_.materials = {material(0.5)};
    }

    // An opaque polygon: the sides NAME+ and NAME−.
    void add_polygon(const std::string& name, const Corners& corners) {
        add_surfaces(scene_, name, {{"", {polygon(corners)}}}, 0);
    }
    // A rectangle in the way, or one that alone is open in a wall at its height.
    void add_screen(const Corners& c, bool aperture) {
        if (!aperture) return add_polygon("screen", c);
        const double wide = 4.0;  // hides more than the two see of each other
        const mesh::Point corner(-wide, -wide, c[0].z);
        const mesh::Opening opening{
            "hole", {c[0].x + wide, c[0].y + wide}, {c[2].x - c[0].x, c[2].y - c[0].y}};
        for (auto& face :
             mesh::rectangle(corner, {2.0 * wide, 0, 0}, {0, 2.0 * wide, 0}, {opening}))
            add_surfaces(scene_, "screen", {face},
                         face.name.empty() ? std::optional<std::size_t>(0) : std::nullopt);
    }
    // Volumes bound by faces that light passes: the medium NAME.
    void add_volume(const std::string& name, const std::vector<Corners>& faces, double extinction) {
        std::vector<mesh::Face> list;
        mesh::Point middle(0.0);
        double count = 0.0;
        for (std::size_t k = 0; k < faces.size(); ++k) {
            list.push_back({std::to_string(k), {polygon(faces[k])}});
            for (const auto& corner : faces[k]) middle += corner;
            count += double(faces[k].size());
        }
        add_surfaces(scene_, name, list, std::nullopt);
        auto filling = medium(extinction, 0.5, middle / count);
        filling.name = name;
        scene_.media.push_back(filling);
    }
    void add_box(const std::string& name, const nlohmann::json& box, double extinction) {
        std::vector<Corners> faces;
        for (int axis = 0; axis < 3; ++axis)
            for (int end = 0; end < 2; ++end) {
                auto flat = box;
                flat[axis] = {box[axis][end], box[axis][end]};
                faces.push_back(rectangle_of(flat));
            }
        add_volume(name, faces, extinction);
    }
    void add_tet(const std::string& name, const Corners& c, double extinction) {
        add_volume(name,
                   {{c[1], c[2], c[3]}, {c[0], c[3], c[2]}, {c[0], c[1], c[3]}, {c[0], c[2], c[1]}},
                   extinction);
    }

    // The exchange area between the two, over all sides of each [m^2].
    double exchange_area(const std::string& method, const radiosity::ExchangeOptions& options,
                         const std::string& from, const std::string& to) {
        if (extinction_ > 0.0) {
            scene_.media.push_back(medium(extinction_, 0.5));
            scene_.media.back().name = "rest";
        }
        const auto enclosure = radiosity::make_enclosure(scene_);
        const auto table =
            radiosity::exchange_table(enclosure, radiosity::exchange_method(method), options,
                                      sides(enclosure, from), sides(enclosure, to));
        return std::accumulate(
            table.entries.begin(), table.entries.end(), 0.0,
            [](double sum, const auto& entry) { return sum + entry.exchange_area[0]; });
    }

  private:
    static mesh::Polygon polygon(const Corners& corners) {
        mesh::Polygon result;
        result.corners = corners;
        return result;
    }
    static std::vector<std::string> sides(const radiosity::Enclosure& enclosure,
                                          const std::string& name) {
        std::vector<std::string> result;
        for (const auto& known : radiosity::exchange_names(enclosure))
            if (known == name || known == name + "+" || known == name + "-")
                result.push_back(known);
        return result;
    }

    double extinction_;
    radiosity::Scene scene_;
};

// The case of a file of reference figures, from "1" to "2".
inline ReferencePair reference_pair(const nlohmann::json& c) {
    const auto& g = c["geometry"];
    const auto& params = c["params"];
    const double one =
        params.contains("kappa1") ? params["kappa1"] : params.value("kappa", nlohmann::json(0.0));
    const double two = params.contains("kappa2") ? double(params["kappa2"]) : one;
    ReferencePair pair(one);
    const auto tet_face = [&](const nlohmann::json& tet, const std::string& which) {
        Corners corners = corners_of(tet);
        corners.erase(corners.begin() + (which.back() - '0'));
        return corners;
    };
    if (g.contains("poly1")) {
        pair.add_polygon("1", corners_of(g["poly1"]));
        pair.add_polygon("2", corners_of(g["poly2"]));
        if (g.contains("screen"))
            pair.add_screen(corners_of(g["screen"]),
                            std::string(c["name"]).starts_with("aperture"));
    } else if (g.contains("rect1")) {
        pair.add_polygon("1", rectangle_of(g["rect1"]));
        pair.add_polygon("2", rectangle_of(g["rect2"]));
    } else if (g.contains("rect")) {
        pair.add_box("1", g["box"], one);
        pair.add_polygon("2", rectangle_of(g["rect"]));
    } else if (g.contains("box1")) {
        pair.add_box("1", g["box1"], one);
        if (g["box1"] != g["box2"]) pair.add_box("2", g["box2"], two);
    } else if (g.contains("face1")) {
        pair.add_polygon("1", tet_face(g["tet"], g["face1"]));
        pair.add_polygon("2", tet_face(g["tet"], g["face2"]));
    } else if (g.contains("tet")) {
        pair.add_tet("1", corners_of(g["tet"]), one);
        pair.add_polygon("2", tet_face(g["tet"], g["face"]));
    } else {
        pair.add_tet("1", corners_of(g["tet1"]), one);
        if (g.contains("face"))
            pair.add_polygon("2", tet_face(g["tet2"], g["face"]));
        else if (g["tet1"] != g["tet2"])
            pair.add_tet("2", corners_of(g["tet2"]), two);
    }
    return pair;
}

// The second thing's name: the first's, where they are the same.
inline std::string second_of(const nlohmann::json& c) {
    const auto& g = c["geometry"];
    const bool same = (g.contains("box1") && g["box1"] == g["box2"]) ||
                      (g.contains("tet1") && !g.contains("face") && g["tet1"] == g["tet2"]);
    return same ? "1" : "2";
}

}  // namespace tyndall::test
