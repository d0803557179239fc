#include "radiosity/element_pieces.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

namespace tyndall::radiosity {
namespace {

std::array<int, 2> longest_edge(const Piece& piece) {
    std::array<int, 2> longest{0, 1};
    double most = -1.0;
    for (int i = 0; i < static_cast<int>(piece.size()); ++i)
        for (int j = i + 1; j < static_cast<int>(piece.size()); ++j) {
            const Direction edge = piece.corners[j] - piece.corners[i];
            const double length = glm::dot(edge, edge);
            if (length > most) most = length, longest = {i, j};
        }
    return longest;
}

}  // namespace

void measure(Piece& piece) {
    const auto& c = piece.corners;
    const Direction n = glm::cross(c[1] - c[0], c[2] - c[0]);
    piece.measure = piece.solid ? glm::dot(n, c[3] - c[0]) / 6.0 : 0.5 * glm::length(n);
    piece.centre = Point(0.0);
    for (std::size_t k = 0; k < piece.size(); ++k) piece.centre += c[k];
    piece.centre /= static_cast<double>(piece.size());
    piece.radius = 0.0;
    for (std::size_t k = 0; k < piece.size(); ++k)
        piece.radius = std::max(piece.radius, glm::distance(c[k], piece.centre));
}

double longest_edge_squared(const Piece& piece) {
    const auto [i, j] = longest_edge(piece);
    const Direction edge = piece.corners[j] - piece.corners[i];
    return glm::dot(edge, edge);
}

std::array<Piece, 2> bisect(const Piece& piece) {
    const auto [i, j] = longest_edge(piece);
    const Point middle = 0.5 * (piece.corners[i] + piece.corners[j]);
    std::array<Piece, 2> halves{piece, piece};
    halves[0].corners[j] = middle;
    halves[1].corners[i] = middle;
    for (Piece& half : halves) measure(half);
    return halves;
}

std::array<PieceFace, 4> outward_faces(const Piece& tetrahedron) {
    std::array<PieceFace, 4> faces;
    for (int k = 0; k < 4; ++k) {
        const auto& f = mesh::face_corners[k];
        const auto& c = tetrahedron.corners;
        const Direction n = glm::cross(c[f[1]] - c[f[0]], c[f[2]] - c[f[0]]);
        const double twice = glm::length(n);
        faces[k] = {{c[f[0]], c[f[1]], c[f[2]]}, n / twice, 0.5 * twice};
    }
    return faces;
}

// A patch itself, or the faces of a tetrahedron with their outward normals.
std::vector<Piece> faces_of(const Piece& piece) {
    if (!piece.solid) return {piece};
    std::vector<Piece> result;
    for (const PieceFace& face : outward_faces(piece)) {
        Piece side{.face = true,
                   .normal = face.normal,
                   .extinction = piece.extinction,
                   .start = piece.start};
        std::ranges::copy(face.corners, side.corners.begin());
        measure(side);
        result.push_back(side);
    }
    return result;
}

bool straddles(const Piece& a, const Piece& b) {
    for (std::size_t k = 0; !a.solid && k < b.size(); ++k)
        if (glm::dot(a.normal, b.corners[k] - a.centre) < -1e-12 * (a.radius + b.radius))
            return true;
    return false;
}

bool behind(const Piece& a, const Piece& b) {
    if (a.solid) return false;
    for (std::size_t k = 0; k < b.size(); ++k)
        if (glm::dot(a.normal, b.corners[k] - a.centre) > 1e-12 * (a.radius + b.radius))
            return false;
    return true;
}

std::vector<Piece> boundary_of(std::span<const Piece> pieces) {
    using Key = std::array<std::array<double, 3>, 3>;
    std::map<Key, std::pair<Piece, int>> faces;
    std::vector<Key> order;
    for (const Piece& piece : pieces)
        for (const Piece& face : faces_of(piece)) {
            Key key;
            for (int k = 0; k < 3; ++k)
                key[k] = {face.corners[k].x, face.corners[k].y, face.corners[k].z};
            std::ranges::sort(key);
            const auto [place, fresh] = faces.try_emplace(key, face, 0);
            ++place->second.second;
            if (fresh) order.push_back(key);
        }
    std::vector<Piece> result;
    for (const Key& key : order)
        if (const auto& [face, uses] = faces.at(key); uses == 1) result.push_back(face);
    return result;
}

ElementPieces::ElementPieces(const Discretization& d, std::size_t band) : band_(band) {
    for (std::size_t i = 0; i < d.elements.size(); ++i) {
        for (const std::uint32_t member : d.elements.members_of(i))
            d.elements.is_patch(i) ? add_patch(d, PatchId(member)) : add_zone(d, ZoneId(member));
        finish_element();
    }
    add_outside(d.enclosure);
    finish_element();
}

void ElementPieces::add_patch(const Discretization& d, PatchId patch) {
    Piece piece;
    for (int k = 0; k < 3; ++k) piece.corners[k] = d.forest.point(d.forest[patch].corners[k]);
    piece.normal = normal_of(d.forest, patch);
    const std::uint32_t side = d.forest.base_facet_side(patch);
    piece.start =
        mesh::start_on(d.enclosure.mesh, FacetId(side / 2), side % 2 ? Side::back : Side::front);
    piece.extinction = d.enclosure.extinction(piece.start.tet, band_);
    measure(piece);
    pieces_.push_back(piece);
}

void ElementPieces::add_zone(const Discretization& d, ZoneId zone) {
    Piece piece;
    piece.solid = true;
    for (int k = 0; k < 4; ++k) piece.corners[k] = d.forest.point(d.forest[zone].corners[k]);
    piece.start.tet = d.forest.base_tet(zone);
    piece.extinction = d.enclosure.extinction(piece.start.tet, band_);
    measure(piece);
    pieces_.push_back(piece);
}

void ElementPieces::add_outside(const Enclosure& enclosure) {
    const auto& mesh = enclosure.mesh;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        if (enclosure.solid(TetId(t))) continue;
        for (int k = 0; k < 4; ++k) {
            const FacetId facet = mesh.tet_facets[t][k];
            if (mesh.neighbours[t][k].valid() ||
                (facet.valid() && mesh.facets[facet.value].opacity == mesh::Opacity::opaque))
                continue;
            Piece piece;
            for (int c = 0; c < 3; ++c)
                piece.corners[c] = mesh.points[mesh.tets[t][mesh::face_corners[k][c]].value];
            piece.normal = -glm::normalize(glm::cross(piece.corners[1] - piece.corners[0],
                                                      piece.corners[2] - piece.corners[0]));
            piece.start = {TetId(t), k};
            piece.extinction = enclosure.extinction(TetId(t), band_);
            measure(piece);
            pieces_.push_back(piece);
        }
    }
}

Ball ball_of(std::span<const Piece> pieces) {
    Ball ball;
    double whole = 0.0;
    for (const Piece& piece : pieces) {
        ball.centre += piece.measure * piece.centre;
        whole += piece.measure;
    }
    if (whole > 0.0) ball.centre /= whole;
    for (const Piece& piece : pieces)
        for (std::size_t k = 0; k < piece.size(); ++k)
            ball.radius = std::max(ball.radius, glm::distance(piece.corners[k], ball.centre));
    return ball;
}

void ElementPieces::finish_element() {
    const auto pieces = std::span(pieces_).subspan(starts_.back());
    balls_.push_back(ball_of(pieces));
    starts_.push_back(pieces_.size());
}

double ElementPieces::gap(std::size_t a, std::size_t b) const {
    return glm::distance(balls_[a].centre, balls_[b].centre) - balls_[a].radius - balls_[b].radius;
}

}  // namespace tyndall::radiosity
