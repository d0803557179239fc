#include "cli/expression.h"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <memory>
#include <numbers>

#include "mesh/input_error.h"

namespace tyndall::cli {
namespace {

struct Compiled {
    double x = 0.0, y = 0.0, z = 0.0;
    mu::Parser parser;
};

// Its messages begin with a capital, end with a full stop, and tell the position themselves.
std::string message_of(const mu::Parser::exception_type& error, const std::string& text) {
    std::string what;
    switch (error.GetCode()) {
        case mu::ecUNASSIGNABLE_TOKEN:
            what = fmt::format("'{}' is not known", error.GetToken());
            break;
        case mu::ecUNEXPECTED_EOF:
            what = "it ends too early";
            break;
        case mu::ecMISSING_PARENS:
            what = "a parenthesis is not closed";
            break;
        default:
            what = error.GetMsg();
            if (!what.empty()) what[0] = static_cast<char>(std::tolower(what[0]));
            while (!what.empty() && what.back() == '.') what.pop_back();
    }
    const auto at = std::clamp<std::ptrdiff_t>(error.GetPos(), 0, std::ptrdiff_t(text.size()));
    return fmt::format(
        "\"{}\" cannot be understood: at character {}, {}. Write an expression of x, y and z [m], "
        "such as \"0.4 * exp(-z / 0.8)\".",
        text, at + 1, what);
}

}  // namespace

std::function<double(mesh::Point)> compile_expression(const std::string& text) {
    const auto compiled = std::make_shared<Compiled>();
    try {
        mu::Parser& parser = compiled->parser;
        parser.DefineConst("pi", std::numbers::pi);
        parser.DefineConst("e", std::numbers::e);
        parser.DefineVar("x", &compiled->x);
        parser.DefineVar("y", &compiled->y);
        parser.DefineVar("z", &compiled->z);
        parser.SetExpr(text);
        parser.Eval();
        if (parser.GetNumResults() != 1 || text.find(';') != std::string::npos)
            throw mesh::InputError(fmt::format(
                "\"{}\" has more than one value. Write one expression; for several bands an array "
                "of them.",
                text));
        // It would change what x, y or z are.
        const std::string operators = "<>=!";
        for (std::size_t k = 0; k < text.size(); ++k)
            if (text[k] == '=' && (k == 0 || operators.find(text[k - 1]) == std::string::npos) &&
                (k + 1 == text.size() || text[k + 1] != '='))
                throw mesh::InputError(fmt::format(
                    "\"{}\" assigns at character {}. Compare with ==, <, >.", text, k + 1));
    } catch (const mu::Parser::exception_type& error) {
        throw mesh::InputError(message_of(error, text));
    }
    return [compiled](mesh::Point p) {
        compiled->x = p.x;
        compiled->y = p.y;
        compiled->z = p.z;
        return compiled->parser.Eval();
    };
}

}  // namespace tyndall::cli
