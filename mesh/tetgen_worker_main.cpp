// tyndall-tetgen: runs TetGen once and dies with it. TetGen ends on bad input by throwing int,
// freeing twice, aborting or eating all memory; none of this may happen in the user's program.
//
// TetGen is (C) Hang Si, AGPL-3.0-or-later; so is this program as a whole.
#ifndef TETLIBRARY
#define TETLIBRARY
#endif
#include <signal.h>
#include <sys/resource.h>
#include <tetgen.h>
#include <unistd.h>

#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <string>
#include <vector>

#include "mesh/tetgen_pipe.h"

namespace {

using namespace tyndall::mesh::tetgen_pipe;

struct Input {
    std::vector<double> points;
    std::vector<std::uint32_t> triangles, quads;
    std::vector<std::int32_t> triangle_markers, quad_markers;
};

template <class T>
void read(std::vector<T>& values, std::uint64_t count) {
    values.resize(count);
    if (std::fread(values.data(), sizeof(T), count, stdin) != count) {
        std::exit(bad_input);
    }
}

Input read_input() {
    Header header{};
    if (std::fread(&header, sizeof header, 1, stdin) != 1 || header.magic != magic) {
        std::exit(bad_input);
    }
    Input input;
    read(input.points, 3 * header.points);
    read(input.triangles, 3 * header.triangles);
    read(input.triangle_markers, header.triangles);
    read(input.quads, 4 * header.quads);
    read(input.quad_markers, header.quads);
    return input;
}

void fill_facet(tetgenio::facet& facet, const std::uint32_t* corners, int count) {
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    tetgenio::init(facet.polygonlist);
    facet.polygonlist->numberofvertices = count;
    facet.polygonlist->vertexlist = new int[static_cast<std::size_t>(count)];
    std::copy(corners, corners + count, facet.polygonlist->vertexlist);
}

void fill(const Input& input, tetgenio& io) {
    io.firstnumber = 0;
    io.numberofpoints = static_cast<int>(input.points.size() / 3);
    io.pointlist = new REAL[input.points.size()];
    std::copy(input.points.begin(), input.points.end(), io.pointlist);
    const auto triangles = input.triangle_markers.size(), quads = input.quad_markers.size();
    io.numberoffacets = static_cast<int>(triangles + quads);
    io.facetlist = new tetgenio::facet[triangles + quads];
    io.facetmarkerlist = new int[triangles + quads];
    for (std::size_t i = 0; i < triangles; ++i) {
        fill_facet(io.facetlist[i], &input.triangles[3 * i], 3);
        io.facetmarkerlist[i] = input.triangle_markers[i];
    }
    for (std::size_t i = 0; i < quads; ++i) {
        fill_facet(io.facetlist[triangles + i], &input.quads[4 * i], 4);
        io.facetmarkerlist[triangles + i] = input.quad_markers[i];
    }
}

template <class T>
bool write(std::FILE* out, const T* values, std::size_t count) {
    return count == 0 || std::fwrite(values, sizeof(T), count, out) == count;
}

bool write_output(std::FILE* out, const tetgenio& io) {
    const auto points = static_cast<std::size_t>(std::max(io.numberofpoints, 0));
    const auto tets = static_cast<std::size_t>(std::max(io.numberoftetrahedra, 0));
    const auto faces = static_cast<std::size_t>(std::max(io.numberoftrifaces, 0));
    const Result result{magic, points, tets, faces};
    const std::vector<int> none(faces, 0);
    return (tets == 0 || io.numberofcorners == 4) && write(out, &result, 1) &&
           write(out, io.pointlist, 3 * points) && write(out, io.tetrahedronlist, 4 * tets) &&
           write(out, io.trifacelist, 3 * faces) &&
           write(out, io.trifacemarkerlist ? io.trifacemarkerlist : none.data(), faces) &&
           std::fflush(out) == 0;
}

void limit(int resource, rlim_t value, rlim_t grace = 0) {
    const rlimit limits{value, value + grace};
    setrlimit(static_cast<__rlimit_resource>(resource), &limits);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) {
        std::fprintf(stderr,
                     "tyndall-tetgen SWITCHES SECONDS BYTES: run by Tyndall, not by hand\n");
        return 2;
    }
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, std::strtoull(argv[2], nullptr, 10), 1);  // SIGXCPU first, then SIGKILL
    limit(RLIMIT_AS, std::strtoull(argv[3], nullptr, 10));

    // TetGen prints to stdout; that is for the result alone.
    std::FILE* out = fdopen(dup(STDOUT_FILENO), "wb");
    dup2(STDERR_FILENO, STDOUT_FILENO);
    int code = 0;
    try {
        const auto input = read_input();
        tetgenio in, result;
        fill(input, in);
        std::string switches = argv[1];
        ::tetrahedralize(switches.data(), &in, &result);
        code = write_output(out, result) ? 0 : static_cast<int>(refused);
    } catch (const std::bad_alloc&) {
        code = no_memory;
    } catch (int reason) {
        code = reason == 1 ? no_memory : refused;  // terminatetetgen's numbers
        std::fprintf(stderr, "TetGen's reason %d\n", reason);
    } catch (...) {
        code = refused;
    }
    std::fflush(stdout);
    _exit(code);  // past TetGen's destructors, which free twice
}
