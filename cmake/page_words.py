"""python3 page_words.py app/screens/words.h: the words of the page around the program, as a script for the page."""
import json
import re
import sys

text = open(sys.argv[1], encoding="utf-8").read()
words = {}
for name, literals in re.findall(r'const char\* page(\w+) =\s*((?:"(?:[^"\\]|\\.)*"\s*)+);', text):
    words[name[0].lower() + name[1:]] = "".join(json.loads(literal) for literal in re.findall(r'"(?:[^"\\]|\\.)*"', literals))
print("// Of app/screens/words.h.\n'use strict';\n")
print("const palpaWords = %s;" % json.dumps(words, indent=0, separators=(",", ":"), ensure_ascii=False))
print("const palpaFilled = (pattern, ...values) => pattern.replace(/\\{\\}/g, () => values.shift());")
