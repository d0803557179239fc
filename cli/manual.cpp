#include "cli/manual.h"

#include <fmt/format.h>
#include <algorithm>

namespace tyndall::cli {
namespace {

// A UTF-8 sequence as its code point; `at` goes behind it.
unsigned code_point(const std::string& text, std::size_t& at) {
    const auto lead = static_cast<unsigned char>(text[at++]);
    unsigned value = lead >= 0xF0 ? lead & 0x07u : lead >= 0xE0 ? lead & 0x0Fu : lead & 0x1Fu;
    for (; at < text.size() && (text[at] & 0xC0) == 0x80; ++at)
        value = value << 6 | (static_cast<unsigned char>(text[at]) & 0x3Fu);
    return value;
}

// What troff would read as commands is none: backslashes, a dot or quote that begins a line. A
// hyphen is a minus, which can be copied into a shell.
std::string troff_escaped(const std::string& text) {
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        const char c = text[at];
        const bool begins = result.empty() || result.back() == '\n';
        if (static_cast<unsigned char>(c) >= 0x80) {
            result += fmt::format("\\[u{:04X}]", code_point(text, at));
            continue;
        }
        if (begins && (c == '.' || c == '\'')) result += "\\&";
        if (c == '\\')
            result += "\\e";
        else if (c == '-')
            result += "\\-";
        else if (c == '~')
            result += "\\(ti";
        else if (c == '^')
            result += "\\(ha";
        else if (c == '\'')
            result += "\\(aq";
        else
            result += c;
        ++at;
    }
    return result;
}

std::string option_text(const OptionDescription& option) {
    std::string names;
    for (const auto& name : option.names)
        names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", troff_escaped(name));
    if (!option.value.empty()) names += fmt::format(" \\fI{}\\fR", troff_escaped(option.value));
    return fmt::format(".TP\n{}\n{}{}\n", names, troff_escaped(option.help),
                       option.required ? " (required)" : "");
}

std::string examples_text(const std::vector<std::string>& examples) {
    std::string text;
    for (const auto& example : examples) {
        const auto [line, comment] = example_of(example);
        if (!comment.empty()) text += fmt::format("# {}\n", troff_escaped(comment));
        text += troff_escaped(line) + "\n";
    }
    return text.empty() ? "" : fmt::format(".PP\n.EX\n{}.EE\n", text);
}

std::string synopsis(const CommandDescription& command) {
    std::string text = fmt::format("\\fBtyndall {}\\fR", command.name);
    for (const auto& option : command.options)
        if (option.positional) {
            const auto name = fmt::format("\\fI{}\\fR", troff_escaped(option.names.front()));
            text += option.required ? " " + name : " [" + name + "]";
        }
    for (const auto& option : command.options)
        if (!option.positional && option.required)
            text += fmt::format(" \\fB{}\\fR \\fI{}\\fR", troff_escaped(option.names.front()),
                                troff_escaped(option.value));
    return text + " [\\fIFLAGS\\fR]";
}

std::string command_text(const CommandDescription& command) {
    std::string text = fmt::format(".SS {}\n{}\n.PP\n{}.\n", troff_escaped(command.name),
                                   synopsis(command), troff_escaped(command.purpose));
    for (const auto& option : command.options)
        if (!option.common && option.names.back() != "--help") text += option_text(option);
    return text + examples_text(command.examples);
}

// The flags that most commands share, once each.
std::string common_text(const ProgramDescription& program) {
    std::string text;
    std::vector<std::string> told;
    for (const auto& command : program.commands)
        for (const auto& option : command.options) {
            const bool known =
                std::find(told.begin(), told.end(), option.names.back()) != told.end();
            if (!option.common || known) continue;
            told.push_back(option.names.back());
            text += option_text(option);
        }
    return text;
}

constexpr const char* ending =
    R"(.SH EXIT STATUS
.TP
.B 0
Done. A goal that was not reached is a result; the report says so.
.TP
.B 1
Bad input, or a run that failed: one message on standard error says what, where, and what to do.
.TP
.B 2
Wrong usage.
.SH FILES
.TP
.I SCENE
What there is, in TOML: metres, watts, z up. \fBtyndall new\fR writes one that explains itself.
.TP
.I OUT
The folder of a run: image.png, image.exr (layers), view.html, solution.vtkhdf (for ParaView and for
render, view, probe, compare), report.json.
.PP
Interrupting a run (Ctrl\-C) leaves a valid solution.
.SH SEE ALSO
.BR paraview (1)
)";

}  // namespace

std::string manual_page(const ProgramDescription& program) {
    std::string commands;
    for (const auto& command : program.commands) commands += command_text(command);
    return fmt::format(
        R"(.\" Made by: tyndall man
.TH TYNDALL 1 "" "Tyndall {0}" "User Commands"
.SH NAME
tyndall \- {1}
.SH SYNOPSIS
\fBtyndall\fR \fICOMMAND\fR [\fIFLAGS\fR]
.br
\fBtyndall\fR \fICOMMAND\fR \fB\-\-help\fR
.br
\fBtyndall\fR \fB\-\-version\fR
.SH DESCRIPTION
Computes where light goes in rooms, smoke, fog and furnaces: radiosity for surfaces and for the media
between them, on a mesh that refines itself. A scene file says what there is; a run gives a picture, a page
to walk through, a solution and a report.
{2}.SH COMMANDS
{3}.SH COMMON FLAGS
Every command that has a use for one takes it.
{4}{5})",
        program.version, troff_escaped(program.purpose), examples_text(program.examples), commands,
        common_text(program), ending);
}

}  // namespace tyndall::cli
