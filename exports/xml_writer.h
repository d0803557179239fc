// XML, line by line.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tyndall::exports {

class XmlWriter {
  public:
    using Attributes = std::vector<std::pair<std::string, std::string>>;

    // An element that is open until close(), or the end of its life.
    class Open {
      public:
        Open(XmlWriter& writer, std::string name) : writer_(&writer), name_(std::move(name)) {}
        ~Open() { close(); }
        Open(const Open&) = delete;
        Open& operator=(const Open&) = delete;

        void close();

      private:
        XmlWriter* writer_;
        std::string name_;
    };

    [[nodiscard]] Open element(const std::string& name, const Attributes& attributes);
    // Its content is written by `inside`.
    template <class Inside>
    void element(const std::string& name, const Attributes& attributes, Inside&& inside) {
        const auto open = element(name, attributes);
        inside();
    }
    void leaf(const std::string& name, const Attributes& attributes);  // without content
    void comment(std::string text);

    const std::string& text() const { return text_; }

  private:
    void begin(const std::string& name, const Attributes& attributes);

    std::string text_ = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n";
    std::size_t depth_ = 0;
};

}  // namespace tyndall::exports
