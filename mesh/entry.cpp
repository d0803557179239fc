#include "mesh/entry.h"

namespace tyndall::mesh {

Entry entry_of(const BaseMesh& mesh, const Ray& ray, TetId at_origin) {
    if (at_origin.valid()) return {at_origin, 0.0};
    double t_in = 0.0, t_out = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const double inverse = 1.0 / ray.direction[k];
        double a = (mesh.hull_min[k] - ray.origin[k]) * inverse;
        double b = (mesh.hull_max[k] - ray.origin[k]) * inverse;
        if (a > b) std::swap(a, b);
        t_in = std::max(t_in, a);
        t_out = std::min(t_out, b);
    }
    if (!(t_in < t_out)) return {};
    const double inside = t_in + 1e-9 * (t_out - t_in);
    return {locate(mesh, ray.origin + inside * ray.direction), inside};
}

Entry entry_near(const BaseMesh& mesh, const Ray& ray, Point x, TetId at_x) {
    return entry_of(mesh, ray, ray.origin == x ? at_x : locate(mesh, ray.origin, at_x));
}

}  // namespace tyndall::mesh
