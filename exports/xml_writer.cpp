#include "exports/xml_writer.h"

namespace tyndall::exports {
namespace {

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

}  // namespace

void XmlWriter::begin(const std::string& name, const Attributes& attributes) {
    text_.append(2 * depth_, ' ');
    text_.append("<").append(name);
    for (const auto& [key, value] : attributes)
        text_.append(" ").append(key).append("=\"").append(escaped(value)).append("\"");
}

XmlWriter::Open XmlWriter::element(const std::string& name, const Attributes& attributes) {
    begin(name, attributes);
    text_ += ">\n";
    ++depth_;
    return {*this, name};
}

void XmlWriter::Open::close() {
    if (!writer_) return;
    --writer_->depth_;
    writer_->text_.append(2 * writer_->depth_, ' ');
    writer_->text_.append("</").append(name_).append(">\n");
    writer_ = nullptr;
}

void XmlWriter::leaf(const std::string& name, const Attributes& attributes) {
    begin(name, attributes);
    text_ += "/>\n";
}

void XmlWriter::comment(std::string text) {
    // No two hyphens may stand in a comment.
    for (std::size_t at; (at = text.find("--")) != std::string::npos;) text.replace(at, 2, "-");
    text_.append(2 * depth_, ' ');
    text_.append("<!-- ").append(text).append(" -->\n");
}

}  // namespace tyndall::exports
