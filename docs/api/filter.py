#!/usr/bin/env python3
"""Doxygen's input filter: headers as the house writes them, as Doxygen reads them.

    // text             before a declaration   ->  /// text
    declaration;  // text, and lines below that go on with it  ->  ///< text
    a first comment     ->  @file, and of the type that has the file for itself
    "Purpose: ...", "Errors: ..."              ->  a paragraph each
Declarations that follow each other without a blank line between share the comment above the first;
what has a comment of its own keeps that.

    docs/api/filter.py mesh/walk.h
"""
import re
import sys

PARAGRAPH = re.compile(r"^([A-Z][A-Za-z ]{2,20}): ")
WHOLE = re.compile(r"^(\s*)//(.*)$")
TRAILING = re.compile(r"^(.*?\S)(\s+)// ?(.*)$")
TYPE = re.compile(r"^(template .*)?(struct|class|enum class) \w+[^;]*\{")
NO_DECLARATION = re.compile(r"^\s*(#|\}|public:|private:|protected:|namespace|friend|using namespace|$)")


def safe(text):
    """Nothing in it is a command or a tag of Doxygen's."""
    return re.sub(r'([\\@<>#&%"])', r"\\\1", text.strip())


def several(code):
    """Whether a line declares more than one variable: `int a = 0, b = 0;`"""
    plain = code
    while True:  # what is within brackets is not read
        shorter = re.sub(r"<[^<>]*>|\([^()]*\)|\{[^{}]*\}", "", plain)
        if shorter == plain:
            return plain.rstrip().endswith(";") and "," in plain
        plain = shorter


def block(texts, indent):
    lines = []
    for text in texts:
        if PARAGRAPH.match(text.strip()) and lines:
            lines.append(f"{indent}///")
        lines.append(f"{indent}/// {safe(text)}")
    return lines


class Filter:
    def __init__(self, lines):
        self.lines = lines
        self.k = 0
        self.out = []
        self.about_file = None  # the first comment, until a type has it
        self.above = []  # the comment that a block of declarations shares
        self.fresh = False  # it has just been written
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

    def code(self):
        line = self.lines[self.k]
        indent = re.match(r"\s*", line).group(0)
        found = TRAILING.match(line)
        if found and found.group(1).count('"') % 2 == 1:
            found = None
        declares = not self.open and not NO_DECLARATION.match(line)
        if declares and not self.fresh:
            if TYPE.match(line) and self.about_file:
                self.out += block(self.about_file, indent)
                self.about_file = []
            elif self.above and not self.comment_at_end():
                self.out += block(self.above, indent)
        self.k += 1
        code = line
        if found:
            texts = self.trailing_text(found)
            code = found.group(1)
            if code.endswith("{"):  # of a type: Doxygen wants it above
                self.out += block(texts, indent) if declares and not self.fresh else []
                self.out.append(code)
            elif several(code) and declares:
                self.out += block(texts, indent) + [code]
            else:
                self.out.append(f"{code}  ///< {safe(texts[0])}")
                self.out += [f"{indent}///< {safe(text)}" for text in texts[1:]]
        else:
            self.out.append(line)
        if TYPE.match(line):
            self.above = []
            self.about_file = self.about_file and []
        self.fresh = False
        plain = re.sub(r'"(\\.|[^"\\])*"', "", code).rstrip()
        self.open = not NO_DECLARATION.match(line) and not re.search(r"[;{}:,]$|^\s*template <.*>$", plain)

    def run(self):
        while self.k < len(self.lines):
            if not self.lines[self.k].strip():
                self.above, self.fresh = [], False
                self.out.append("")
                self.k += 1
            elif WHOLE.match(self.lines[self.k]):
                self.whole()
            else:
                self.code()
        return self.out


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        print("\n".join(Filter(file.read().split("\n")).run()))


if __name__ == "__main__":
    main()
