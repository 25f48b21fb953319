#!/usr/bin/env python3
"""Generates C# from a spec: reads the output of `fcproto inspect` with the target's options, and prints files.

`fc.yaml` names this program. The code shared by all messages is in `runtime`. This program gives each type its C# name,
and names each field once. It uses only the standard library.
"""

import json
import sys
from xml.sax.saxutils import escape

# Types of the spec: type in C#, codec, and `True` if C# allows no null there.
SCALARS = {
    "bool": ("bool", "Bool"),
    "i8": ("sbyte", "I8"),
    "i16": ("short", "I16"),
    "i32": ("int", "I32"),
    "i64": ("long", "I64"),
    "u8": ("byte", "U8"),
    "u16": ("ushort", "U16"),
    "u32": ("uint", "U32"),
    "u64": ("ulong", "U64"),
    "f32": ("float", "F32"),
    "f64": ("double", "F64"),
    "timestamp_ms": ("long", "I64"),
    "timestamp_s": ("long", "I64"),
}
OBJECTS = {"string": ("string", "Text"), "base64": ("byte[]", "Base64"), "json": ("Json", "Any")}

KEYWORDS = set(
    """
    abstract as base bool break byte case catch char checked class const continue decimal default delegate do
    double else enum event explicit extern false finally fixed float for foreach goto if implicit in int interface
    internal is lock long namespace new null object operator out override params private protected public readonly
    ref return sbyte sealed short sizeof stackalloc static string struct switch this throw true try typeof uint
    ulong unchecked unsafe ushort using virtual void volatile while
    """.split()
)
# Names of the runtime, of generated code, and of every C# object.
OWN_TYPES = set(
    """
    Bodies Codec Codecs Constraint Enums Fault Faults Form Frame HeaderField HeaderRole Json Layout Message
    Nothing Operation Operations RequestEnvelope ResponseEnvelope Shape Shapes System Tables Wire
    """.split()
)
OWN_MEMBERS = set(
    """
    Equals Extra Finalize GetHashCode GetType MemberwiseClone ReferenceEquals ShapeOfThis ToJson ToString Value
    """.split()
)


class Unusable(Exception):
    """The spec has something that this program or C# cannot express."""


def pascal(name):
    return "".join(word[:1].upper() + word[1:] for word in name.split("_"))


def camel(name):
    spelled = pascal(name)
    spelled = spelled[:1].lower() + spelled[1:]
    return "@" + spelled if spelled in KEYWORDS else spelled


def named(names, taken, where):
    """Returns the C# names by those of the spec. A taken name gets a `_`; two names that become one are an error."""
    found = {}
    for name in names:
        spelled = pascal(name)
        spelled = spelled + "_" if spelled in taken else spelled
        for other, its in found.items():
            if its == spelled:
                raise Unusable(f"{where}: `{other}` and `{name}` are both `{spelled}` in C#")
        found[name] = spelled
    return found


def text(value):
    """Returns a C# string."""
    return json.dumps(value)


def summary(pad, item, *facts):
    """Returns a comment in both languages, with the facts after it."""
    parts = [f"{item['zh']} {item['en']}"]
    if item.get("about"):
        parts += [item["about"]["zh"], item["about"]["en"]]
    if item.get("note"):
        parts += [item["note"]["zh"], item["note"]["en"]]
    parts += [fact for fact in facts if fact]
    lines = [escape(line.strip()) for part in parts for line in part.split("\n") if line.strip()]
    if len(lines) == 1:
        return [f"{pad}/// <summary>{lines[0]}</summary>"]
    return [
        f"{pad}/// <summary>{lines[0]}</summary>",
        f"{pad}/// <remarks>",
        *(f"{pad}/// <para>{line}</para>" for line in lines[1:]),
        f"{pad}/// </remarks>",
    ]


def obsolete(pad, item):
    deprecated = item.get("deprecated")
    return [f"{pad}[global::System.Obsolete({text(deprecated['en'])})]"] if deprecated else []


def place(item):
    where = item.get("place")
    return f"Spec: {where['name']} in {where['file']}:{where['line']}." if where else ""


def bound(value, is_float):
    return "null" if value is None else repr(value) + "d" if is_float else f"{value}m"


def pattern(value):
    """Returns a regular expression of the spec in the syntax of .NET."""
    for words in ("[[:", "\\x{", "\\u{", "\\U{", "\\<", "\\>", "(?x", "\\A", "\\z", "\\b{"):
        if words in value:
            raise Unusable(f"the pattern `{value}`: .NET has no `{words}`")
    return value.replace("(?P<", "(?<")


class Field:
    """A field of a message: its C# type and its form in JSON."""

    def __init__(self, package, struct, field, name):
        self.field, self.name, self.key = field, name, field["path"]
        self.optional = field["optional"]
        quirks = field.get("quirks", [])
        form = field.get("wire_form", "plain")
        lenient = "lenient_number" in quirks or "lenient_bool" in quirks
        self.type, self.codec, self.is_value = package.type_of(field["type"], form, lenient)
        self.declared = self.type + "?" if self.optional and self.is_value else self.type
        self.traits = [f".Also({text(key)})" for key in field.get("also", [])]
        innermost = field["type"].strip("[]")
        low, high = field.get("min"), field.get("max")
        if low is not None or high is not None:
            is_float = innermost in ("f32", "f64")
            self.traits.append(
                f".{'Between' if is_float else 'Within'}({bound(low, is_float)}, {bound(high, is_float)})"
            )
        if field.get("length"):
            self.traits.append(".Length({}, {})".format(*field["length"]))
        if field.get("pattern"):
            self.traits.append(f".Pattern({text(pattern(field['pattern']))})")
        if field.get("only"):
            only = [text(value) if isinstance(value, str) else f"{value}m" for value in field["only"]]
            self.traits.append(f".Only({', '.join(only)})")
        self.traits += [".EmptyIsAbsent()"] if "empty_is_absent" in quirks else []
        self.traits += [".Sensitive()"] if field.get("sensitive") else []
        # The struct of an enum of texts may be empty.
        self.is_text_enum = package.is_text_enum(field["type"])

    def property(self):
        field, facts = self.field, []
        if field.get("unit"):
            facts.append(f"Unit: {field['unit']}.")
        if field.get("min") is not None or field.get("max") is not None:
            facts.append(f"Range: {field.get('min', '')} … {field.get('max', '')}.")
        if field.get("default") is not None:
            facts.append(f"Taken for {json.dumps(field['default'], ensure_ascii=False)} where it is absent.")
        lines = summary(
            "        ", field, f"Key: {self.key}. {'Optional.' if self.optional else 'Required.'}", " ".join(facts)
        )
        return ["", *lines, *obsolete("        ", field), f"        public {self.declared} {self.name} {{ get; set; }}"]

    def described(self):
        value = f"m => m.{self.name}" + (".Value" if self.optional and self.is_value else "")
        there = f", m => m.{self.name} != null"
        if not self.optional and self.is_value:
            there = f", m => m.{self.name}.Value != null" if self.is_text_enum else ""
        how = "Optional" if self.optional else "Required"
        access = f"{value}, (m, v) => m.{self.name} = v{there}"
        said = f"            .{how}({text(self.key)}, {self.codec}, {access})"
        return [said, *(f"                {trait}" for trait in self.traits)]


class Package:
    """All files of a spec."""

    def __init__(self, dump):
        self.dump = dump
        self.namespace = (dump.get("options") or {}).get("namespace") or pascal(dump["protocol"]["id"])
        self.types = {ty["name"]: ty for ty in dump["types"]}
        self.names = named(self.types, OWN_TYPES, "types")
        self.choices = {}
        for ty in dump["types"]:
            if ty["kind"] == "one_of":
                self.names[ty["name"]] = "I" + self.names[ty["name"]]
                for variant in ty["variants"]:
                    self.choices.setdefault(variant["type"], []).append(ty["name"])
        if len(set(self.names.values())) < len(self.names):
            raise Unusable("a type has the name of the interface of a choice")

    def is_text_enum(self, name):
        ty = self.types.get(name)
        return ty is not None and ty["kind"] == "enum" and ty["repr"] == "string"

    def type_of(self, name, form, lenient):
        """Returns a type in C#, the expression of its codec, and `True` if it takes no null."""
        if name.startswith("["):
            item, codec, _ = self.type_of(name[1:-1], form, lenient)
            return f"IList<{item}>", f"Codecs.List({codec})", False
        if name in SCALARS:
            spelled, codec = SCALARS[name]
            how = f"Form.{pascal(form)}" if form != "plain" else ""
            how = f"{how}, true" if lenient and how else "lenient: true" if lenient else how
            return spelled, f"Codecs.{codec}({how})", True
        if name in OBJECTS:
            spelled, codec = OBJECTS[name]
            return spelled, f"Codecs.{codec}", False
        ty, spelled = self.types[name], self.names[name]
        if ty["kind"] == "enum":
            return spelled, f"Enums.{spelled}({'lenient: true' if lenient and ty['repr'] != 'string' else ''})", True
        if ty["kind"] == "struct":
            return spelled, f"Codecs.Object(() => Shapes.{spelled})", False
        variants = ", ".join(f"() => Shapes.{self.names[variant['type']]}" for variant in ty["variants"])
        return spelled, f"Codecs.Choice<{spelled}>({variants})", False

    def message(self, ty, name):
        """Returns the class of a struct, with the shape of its fields."""
        taken = OWN_MEMBERS | {name}
        members = named([field["name"] for field in ty["fields"]], taken, f"the type `{ty['name']}`")
        fields = [Field(self, ty, field, members[field["name"]]) for field in ty["fields"]]
        bases = ["Message", *(self.names[choice] for choice in self.choices.get(ty["name"], []))]
        lines = [*summary("    ", ty, place(ty)), f"    public sealed class {name} : {', '.join(bases)}", "    {"]
        required = [field for field in fields if not field.optional]
        if required:
            parameters = ", ".join(f"{field.type} {camel(field.field['name'])}" for field in required)
            lines += [
                "        /// <summary>With what every such message has.</summary>",
                f"        public {name}({parameters})",
                "        {",
            ]
            lines += [f"            {field.name} = {camel(field.field['name'])};" for field in required]
            lines += ["        }", "", f"        internal {name}()", "        {", "        }"]
        for field in fields:
            lines += field.property()
        lines += ["", f"        internal override Shape ShapeOfThis => Shapes.{name};", "    }"]
        shape = [f"        /// <summary>The fields of {name}.</summary>"]
        shape += [f"        public static readonly Shape<{name}> {name} = new Shape<{name}>(() => new {name}())"]
        for field in fields:
            shape += field.described()
        shape[-1] += ";"
        return lines, shape

    def number_enum(self, ty, name):
        members = named([value["name"] for value in ty["values"]], {name}, f"the enum `{ty['name']}`")
        is_open = "" if ty["closed"] else "There may be values that this list does not have: they are kept."
        lines = [
            *summary("    ", ty, is_open, place(ty)),
            f"    public enum {name} : {SCALARS[ty['repr']][0]}",
            "    {",
        ]
        for value in ty["values"]:
            lines += [*summary("        ", value), f"        {members[value['name']]} = {value['value']},", ""]
        return [*lines[:-1], "    }"]

    def text_enum(self, ty, name):
        members = named([value["name"] for value in ty["values"]], {name, *OWN_MEMBERS}, f"the enum `{ty['name']}`")
        is_open = "" if ty["closed"] else "There may be values that this list does not have: they are kept."
        lines = [
            *summary("    ", ty, is_open, place(ty)),
            f"    public struct {name} : global::System.IEquatable<{name}>",
            "    {",
        ]
        lines += [
            "        /// <summary>The value that travels as this text.</summary>",
            f"        public {name}(string value)",
            "        {",
            "            Value = value;",
            "        }",
            "",
        ]
        lines += ["        /// <summary>As it travels.</summary>", "        public string Value { get; }", ""]
        for value in ty["values"]:
            lines += [
                *summary("        ", value),
                f"        public static {name} {members[value['name']]} => new {name}({text(value['value'])});",
                "",
            ]
        for line in (
            f"bool Equals({name} other) => Value == other.Value;",
            f"override bool Equals(object other) => other is {name} && Equals(({name})other);",
            "override int GetHashCode() => Value == null ? 0 : Value.GetHashCode();",
            'override string ToString() => Value ?? "";',
            f"static bool operator ==({name} left, {name} right) => left.Equals(right);",
            f"static bool operator !=({name} left, {name} right) => !left.Equals(right);",
        ):
            lines += ["        /// <summary>By its text.</summary>", f"        public {line}", ""]
        return [*lines[:-1], "    }"]

    def enum_codec(self, ty, name):
        values = ", ".join(
            text(value["value"]) if isinstance(value["value"], str) else str(value["value"]) for value in ty["values"]
        )
        closed = f"true, {values}" if ty["closed"] else "false"
        if ty["repr"] == "string":
            made = f"Codecs.Enum<{name}, string>(Codecs.Text, v => new {name}(v), v => v.Value, {closed})"
            return f"internal static Codec<{name}> {name}() => {made};"
        spelled, codec = SCALARS[ty["repr"]]
        wire = f"Codecs.{codec}(lenient: lenient)"
        made = f"Codecs.Enum<{name}, {spelled}>({wire}, v => ({name})v, v => ({spelled})v, {closed})"
        return f"internal static Codec<{name}> {name}(bool lenient = false) => {made};"

    def types_file(self, group):
        """Returns the types of a group; shared types are in no group."""
        lines, shapes = [], []
        for ty in self.dump["types"]:
            if ty["group"] != group:
                continue
            name = self.names[ty["name"]]
            if ty["kind"] == "struct":
                made, shape = self.message(ty, name)
                shapes += ["", *shape]
            elif ty["kind"] == "enum":
                made = self.text_enum(ty, name) if ty["repr"] == "string" else self.number_enum(ty, name)
            else:
                forms = "One of: " + ", ".join(self.names[variant["type"]] for variant in ty["variants"]) + "."
                made = [*summary("    ", ty, forms, place(ty)), f"    public interface {name}", "    {", "    }"]
            lines += ["", *made]
        if shapes:
            lines += ["", "    public static partial class Shapes", "    {", *shapes[1:], "    }"]
        return lines[1:]

    def enums_file(self):
        enums = [ty for ty in self.dump["types"] if ty["kind"] == "enum"]
        codecs = [f"        {self.enum_codec(ty, self.names[ty['name']])}" for ty in enums]
        return [
            "    /// <summary>How the enums travel.</summary>",
            "    internal static class Enums",
            "    {",
            *codecs,
            "    }",
        ]

    def operations_file(self):
        operations = self.dump["operations"]
        names = named(
            [operation["name"] for operation in operations],
            {"Operations", "All", *OWN_MEMBERS, "Operation", "Shapes"},
            "operations",
        )
        lines = [
            "    /// <summary>Commands, reports and streams.</summary>",
            "    public static class Operations",
            "    {",
        ]
        for operation in operations:
            code = "null" if operation["code"] is None else operation["code_spelling"]
            bodies = [
                f"Shapes.{self.names[body['type']]}" if body and body["type"] else "null"
                for body in (operation["request"], operation["response"])
            ]
            said = f"{text(operation['name'])}, {text(operation['kind'])}, {code}, {', '.join(bodies)}"
            lines += summary("        ", operation, place(operation)) + obsolete("        ", operation)
            lines += [
                f"        public static readonly Operation {names[operation['name']]} = new Operation({said});",
                "",
            ]
        lines += [
            "        /// <summary>All of them.</summary>",
            "        public static readonly IReadOnlyList<Operation> All = new[]",
            "        {",
        ]
        return [*lines, *(f"            {name}," for name in names.values()), "        };", "    }"]

    def wire_file(self):
        """Returns the layout of frames, and the envelopes, which are messages like any others."""
        protocol = self.dump["protocol"]
        frame, limits = protocol["frame"], protocol["limits"]
        kinds = ", ".join(f"{{ {kind['value']}, {text(kind['role'])} }}" for kind in frame["kinds"])
        encodings = {encoding["role"]: encoding["value"] for encoding in frame["encodings"]}
        by_role = {field["role"]: field for field in frame["header"]}
        zero = "zero_when_plain" in by_role.get("plain_length", {}).get("quirks", [])
        head = [", ".join(map(str, frame[which])) for which in ("request_head", "response_head")]
        lines = [
            *summary("    ", protocol),
            "    public static class Wire",
            "    {",
            "        /// <summary>How a frame is laid out.</summary>",
        ]
        lines += [
            "        public static readonly Layout Layout = new Layout",
            "        {",
            f"            IsBigEndian = {str(frame['byte_order'] == 'big').lower()},",
            "            Header = new[]",
            "            {",
        ]
        for field in frame["header"]:
            role = pascal(field["role"] or "none")
            where = f"Offset = {field['offset']}, Size = {field['size']}, Value = {field['value']}"
            lines.append(f"                new HeaderField {{ Role = HeaderRole.{role}, {where} }},")
        lines += [
            "            },",
            f"            RequestHead = new byte[] {{ {head[0]} }},",
            f"            ResponseHead = new byte[] {{ {head[1]} }},",
        ]
        lines += [
            f"            Kinds = new Dictionary<ulong, string> {{ {kinds} }},",
            f"            Plain = {encodings.get('plain', 0)},",
        ]
        lines += [
            f"            Gzip = {encodings.get('gzip', 'null')},",
            f"            IsZeroWhenPlain = {str(zero).lower()},",
        ]
        lines += [
            f"            Digest = {text(by_role.get('digest', {}).get('algorithm'))},",
            f"            FrameBytes = {limits['frame_bytes']},",
        ]
        lines += [
            f"            InflatedBytes = {limits['inflated_bytes']},",
            f"            JsonDepth = {limits['json_depth']}",
            "        };",
            "    }",
        ]
        shapes = []
        for side in ("request", "response"):
            fields = [{**field, "path": field["wire"]} for field in protocol["envelope"][side]]
            name = pascal(side) + "Envelope"
            ty = {"name": name, "fields": fields, "zh": "每条消息都有的键。", "en": f"The keys that every {side} has."}
            made, shape = self.message(ty, name)
            lines += ["", *made]
            shapes += ["", *shape]
        return [
            *lines,
            "",
            "    /// <summary>The fields of all messages.</summary>",
            "    public static partial class Shapes",
            "    {",
            *shapes[1:],
            "    }",
        ]

    def tables_file(self):
        names = named([table["id"] for table in self.dump["tables"]], {"Tables", "Bodies", "Shapes"}, "tables")
        lines = ["    /// <summary>Constants of the protocol.</summary>", "    public static class Tables", "    {"]
        for table in self.dump["tables"]:
            row = self.names[table["row"]]
            rows = text(json.dumps(table["rows"], ensure_ascii=False, separators=(",", ":")))
            lines += summary("        ", table, place(table))
            made = f"Bodies.Constants(Shapes.{row}, {rows})"
            lines += [f"        public static readonly IReadOnlyList<{row}> {names[table['id']]} = {made};", ""]
        return [*(lines[:-1] if self.dump["tables"] else lines), "    }"]

    def files(self):
        made = {
            "Wire": self.wire_file(),
            "Enums": self.enums_file(),
            "Operations": self.operations_file(),
            "Tables": self.tables_file(),
        }
        groups = named([group["id"] for group in self.dump["groups"]], made, "groups")
        for group, name in {None: "Shared", **groups}.items():
            lines = self.types_file(group)
            if lines:
                made["Types/" + name] = lines
        version = self.dump["protocol"]["version"]
        for path, lines in made.items():
            opening = [
                f"// Made by `fcproto generate` of version {version} of the spec. Change the spec instead.",
                # Deprecated fields are still read and written.
                "#pragma warning disable 612, 618",
                "using System.Collections.Generic;",
                "using FcRuntime;",
                "",
                f"namespace {self.namespace}",
                "{",
            ]
            yield {"path": path + ".cs", "contents": "\n".join([*opening, *lines, "}", ""])}


def main():
    dump = json.load(sys.stdin)
    if dump["format"] != 3:
        raise Unusable(f"a dump of format {dump['format']}; this program reads 3")
    files = list(Package(dump).files())
    json.dump(files, sys.stdout, ensure_ascii=False)


try:
    main()
except Unusable as why:
    sys.exit(f"plugin.py: {why}")
