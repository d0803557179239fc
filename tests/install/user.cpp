// Ten lines against the installed package: the faces of a room.
#include <cstdio>

#include "mesh/shapes.h"

int main() {
    const auto faces = tyndall::mesh::room({0, 0, 0}, {4, 3, 3});
    for (const auto& face : faces) {
        std::printf("room.%s\n", face.name.c_str());
    }
    return faces.size() == 6 ? 0 : 1;
}
