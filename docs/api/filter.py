#!/usr/bin/env python3
"""Doxygen's input filter: headers as the house writes them, as Doxygen reads them.

    // text             before a declaration   ->  /// text
    declaration;  // text, and lines below that go on with it  ->  ///< text
    a first comment     ->  @file, and of the type that has the file for itself
    "Purpose: ...", "Errors: ..."              ->  a paragraph each
Declarations that follow each other without a blank line between share the comment above the first;
what has a comment of its own keeps that. Without any comment may be
    data members: their names, beside the comment of their type, say what they are
    what means the same everywhere: constructors, ==, size(), empty(), accessors { return x_; }
All else takes its words from words.txt, or Doxygen says that it has none.

    docs/api/filter.py mesh/walk.h      the header as Doxygen reads it
    docs/api/filter.py --unused         fails if words.txt has words that no header needs
"""
import pathlib
import re
import sys

PARAGRAPH = re.compile(r"^([A-Z][A-Za-z ]{2,20}): ")
WHOLE = re.compile(r"^(\s*)//(.*)$")
TRAILING = re.compile(r"^(.*?\S)(\s+)// ?(.*)$")
TYPE = re.compile(r"^(template .*)?(struct|class|enum class) \w+[^;]*\{")
NO_DECLARATION = re.compile(r"^\s*(#|\}|public:|private:|protected:|namespace|friend|using namespace|$)")


CONVENTIONS = {
    "operator==": "Whether all members are the same.",
    "operator<=>": "Orders by index.",
    "operator[]": "The one of that index.",
    "size": "How many there are.",
    "empty": "Whether there is nothing in it.",
    "clear": "Takes out what is in it.",
    "memory": "What it takes [byte].",
    "at": "The value there.",
    "resize": "Makes room, with zeros.",
}
FUNCTION = re.compile(r"(operator ?[^\s(]+|operator\(\)|~?\w+)\(")
ACCESSOR = re.compile(r"\{ return \*?\w+_(\.\w+(\(\))?)?; \}$")
NAME = re.compile(r"(?:using|enum class|struct|class) (\w+)\b(?! ?::)|inline constexpr .*?\b(\w+)(?= = |\{|;)")
FOLDER = pathlib.Path(__file__).resolve().parent


BY_NAME = "by name"  # of data members: what stands in place of words


def own_name(line):
    """What a data member's name says."""
    found = re.search(r"\(\*(\w+)\)", line) or re.search(
        r"(\w+)( = .*|\{.*\}|\[.*\])?[;,]$", line.strip())
    return found.group(1).replace("_", " ") if found else ""


def read_words():
    words = {}
    for line in (FOLDER / "words.txt").read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            name, text = re.match(r"(.*?[^:]): (.*)", line).groups()
            words[name] = text
    return words


WORDS = read_words()


def safe(text):
    """Nothing in it is a command or a tag of Doxygen's."""
    return re.sub(r'([\\@<>#&%"])', r"\\\1", text.strip())


def apart(code):
    """A line that declares several variables, `int a = 0, b = 0;`, as one line each."""
    if not code.rstrip().endswith(";"):
        return [code]
    parts, depth = [""], 0
    for c in code.rstrip()[:-1]:
        depth += (c in "<({[") - (c in ">)}]")
        if c == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += c
    found = re.match(r"^(.*?[\s>*&])(\w+)( = .*|\{.*\}|\[.*\])?$", parts[0])
    if len(parts) == 1 or not found:
        return [code]
    return [f"{parts[0]};"] + [f"{found.group(1)}{part.strip()};" for part in parts[1:]]


def block(texts, indent):
    lines = []
    for text in texts:
        if PARAGRAPH.match(text.strip()) and lines:
            lines.append(f"{indent}///")
        lines.append(f"{indent}/// {safe(text)}")
    return lines


class Filter:
    def __init__(self, lines):
        self.used = set()
        self.types = []  # around this line: (indentation, name)
        self.lines = lines
        self.k = 0
        self.out = []
        self.about_file = None  # the first comment, until a type has it
        self.above = []  # the comment that a block of declarations shares
        self.fresh = False  # it has just been written
        self.open_indent = ""
        self.open = False  # within a declaration of several lines

    def comment_block(self):
        """The lines of a comment from here on."""
        texts = []
        while self.k < len(self.lines) and WHOLE.match(self.lines[self.k]):
            texts.append(WHOLE.match(self.lines[self.k]).group(2))
            self.k += 1
        return texts

    def whole(self):
        indent = WHOLE.match(self.lines[self.k]).group(1)
        texts = self.comment_block()
        if self.about_file is None:
            self.about_file = texts
            self.out += [f"{indent}/// @file"] + block(texts, indent)
            return
        self.above, self.fresh = texts, True
        if not self.open:
            self.out += block(texts, indent)

    def trailing_text(self, found):
        """The comment at a line's end, with the lines below that go on with it."""
        column = len(found.group(1)) + len(found.group(2))
        texts = [found.group(3)]
        while self.k < len(self.lines):
            more = WHOLE.match(self.lines[self.k])
            if not more or len(more.group(1)) != column:
                break
            texts.append(more.group(2))
            self.k += 1
        return texts

    def comment_at_end(self):
        """Whether the declaration that begins here has a comment at its end."""
        for line in self.lines[self.k :]:
            if re.search(r"[;{}]\s*(//.*)?$", line):
                return TRAILING.match(line) is not None
        return False

    def words(self, line):
        """Of a declaration without a comment: its entry in words.txt, or what is so everywhere."""
        around = [name for _, name in self.types]
        function = FUNCTION.search(re.sub(r"(?<!operator )\b(double|void|bool|float)\(", "<", line))
        plain = re.sub(r"^template <.*?> ?", "", line.strip())
        found = NAME.search(plain) if plain.startswith(("using", "inline constexpr", "enum", "struct", "class")) else None
        name = (found.group(1) or found.group(2)) if found else function.group(1) if function else None
        member = re.search(r"(\w+)(,.*| = .*|\{.*\}|\[.*\])?[;,]$", line.strip())
        if name is None and around:
            return [BY_NAME] if member else []
        if name is None:
            return []
        name = "operator" if re.match(r"operator [a-z]", name) else name.replace(" ", "")
        for begin in range(len(around) + 1):
            key = "::".join(around[begin:] + [name])
            if key in WORDS:
                self.used.add(key)
                return [WORDS[key]]
        if around and name == around[-1].split("::")[-1]:
            return ["Constructs it; the type says from what."]
        if around and name in CONVENTIONS:
            return [CONVENTIONS[name]]
        if around and ACCESSOR.search(line):
            return [f"Its {name.replace('_', ' ')}."]
        if found is None and around and re.search(r"^\s*[\w:<>, *]+ \w+(\{.*\}| = .*);$", line):
            return [BY_NAME]
        return []

    def code(self):
        line = self.lines[self.k]
        indent = re.match(r"\s*", line).group(0)
        found = TRAILING.match(line)
        if found and found.group(1).count('"') % 2 == 1:
            found = None
        declares = not self.open and not NO_DECLARATION.match(line)
        above = []  # the comment that is to stand above it
        if declares and not self.fresh:
            whole = line
            if line.lstrip().startswith("template"):
                whole += " " + self.lines[self.k + 1].strip()
            shared = self.above if re.search(r"\(|\busing\b", whole) else []
            if not self.comment_at_end():
                above = shared or self.words(whole)
            if not above and TYPE.match(whole) and not indent and self.about_file:
                above, self.about_file = self.about_file, []
        self.k += 1
        texts = self.trailing_text(found) if found else []
        code = found.group(1) if found else line
        lines = apart(code) if declares else [code]
        if texts and (len(lines) > 1 or code.endswith("{")):
            above = [] if self.fresh and len(lines) == 1 else texts
            texts = []
        if len(lines) > 1 and self.fresh and not above:
            above = self.above
            self.out += [lines.pop(0)]
        for one in lines:
            texts_here = [own_name(one)] if above == [BY_NAME] else above
            self.out += block(texts_here, indent) + [one]
        if texts:
            self.out[-1] += "  ///< " + " ".join(safe(text) for text in texts)
        self.fresh = False
        self.enter(line, code, indent)

    def enter(self, line, code, indent):
        """Keeps track of the types around, and passes over the bodies of functions."""
        type_here = TYPE.match(line.strip())
        if line.strip().startswith("}"):
            self.open = False
        if line.strip().startswith("}") or type_here:
            while self.types and self.types[-1][0] >= len(indent):
                self.types.pop()
        plain = re.sub(r'"(\\.|[^"\\])*"', "", code).rstrip()
        if type_here:
            name = re.search(r"(?:struct|class) ((?:\w+::)*\w+)", line).group(1)
            if not plain.endswith("};"):
                self.types.append((len(indent), name))
            self.above = []
        elif plain.endswith("{") and not plain.lstrip().startswith(("namespace", "extern")):
            begin = indent if not self.open else self.open_indent
            values = ")" not in plain and not self.open
            while self.k < len(self.lines):
                body = self.lines[self.k]
                if body.endswith("};") if values else body.startswith(begin + "}"):
                    break
                self.out.append(body)
                self.k += 1
            if values:  # the last of them is no declaration
                self.out.append(self.lines[self.k])
                self.k += 1
                self.open = False
                return
        was_open = self.open
        self.open = not NO_DECLARATION.match(line) and not re.search(
            r"[;{}:]$|^\s*template <.*>$", plain) and not (self.types and plain.endswith(",") and not was_open and "(" not in plain)
        if self.open and not was_open:
            self.open_indent = indent

    def run(self):
        while self.k < len(self.lines):
            if not self.lines[self.k].strip():
                self.above, self.fresh = [], False
                self.out.append("")
                self.k += 1
            elif self.lines[self.k].startswith("template") and "struct std::" in self.lines[self.k + 1]:
                self.k = self.lines.index("};", self.k) + 1  # what std asks for is no part of ours
            elif WHOLE.match(self.lines[self.k]):
                self.whole()
            else:
                self.code()
        return self.out


def unused():
    """Names in words.txt that nothing needs: they have words in a header now, or are gone."""
    used = set()
    for folder in ("mesh", "radiosity", "render"):
        for header in sorted((FOLDER.parent.parent / folder).glob("*.h")):
            reader = Filter(header.read_text(encoding="utf-8").split("\n"))
            reader.run()
            used |= reader.used
    return sorted(set(WORDS) - used)


def main():
    if sys.argv[1] == "--unused":
        for name in unused():
            print(f"docs/api/words.txt: nothing needs words for {name}. Take the line out.")
        sys.exit(1 if unused() else 0)
    with open(sys.argv[1], encoding="utf-8") as file:
        print("\n".join(Filter(file.read().split("\n")).run()))


if __name__ == "__main__":
    main()
