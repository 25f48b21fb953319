using System.Collections.Generic;
using System.Globalization;
using System.Text;

namespace FcRuntime
{
    /// <summary>The value of a JSON text. Numbers keep their spelling, and keys may be repeated.</summary>
    public sealed class Json
    {
        internal enum Kind
        {
            Null,
            False,
            True,
            Number,
            Text,
            List,
            Object
        }

        internal Json(Kind kind, string text = null)
        {
            Is = kind;
            Spelled = text;
            Items = kind == Kind.List ? new List<Json>() : null;
            Entries = kind == Kind.Object ? new List<KeyValuePair<string, Json>>() : null;
        }

        internal Kind Is { get; }

        /// <summary>The spelling of a number, or the content of a string.</summary>
        internal string Spelled { get; }

        internal List<Json> Items { get; }

        internal List<KeyValuePair<string, Json>> Entries { get; }

        /// <c>true</c> for null and for an empty text, list or object.
        internal bool IsEmpty =>
            Is == Kind.Null || Is == Kind.Text && Spelled.Length == 0
            || Is == Kind.List && Items.Count == 0 || Is == Kind.Object && Entries.Count == 0;

        /// <summary>
        /// Reads a text. Throws <see cref="Fault"/> if it is not JSON, or nested deeper than <c>depth</c> levels.
        /// </summary>
        public static Json Parse(string text, int depth = 64)
        {
            return new JsonReader(text, depth).Whole();
        }

        /// <summary>
        /// Reads the object in a body. An empty body means one without keys. Throws <see cref="Fault"/>.
        /// </summary>
        public static Json ParseBody(byte[] body, int depth)
        {
            if (body.Length == 0)
            {
                return new Json(Kind.Object);
            }
            string text;
            try
            {
                text = Bodies.Utf8.GetString(body);
            }
            catch (DecoderFallbackException error)
            {
                throw new Fault(Faults.NotUtf8, error.Message);
            }
            var read = Parse(text, depth);
            if (read.Is != Kind.Object)
            {
                throw new Fault(Faults.NotAnObject, "the body has to be an object");
            }
            return read;
        }

        /// <summary>Returns the compact text, with the spelling of its numbers.</summary>
        public override string ToString()
        {
            var text = new Output();
            Write(text);
            return text.ToString();
        }

        internal void Write(Output to)
        {
            switch (Is)
            {
                case Kind.Null:
                    to.Append("null");
                    break;
                case Kind.False:
                    to.Append("false");
                    break;
                case Kind.True:
                    to.Append("true");
                    break;
                case Kind.Number:
                    to.Append(Spelled);
                    break;
                case Kind.Text:
                    WriteText(Spelled, to);
                    break;
                case Kind.List:
                    var opening = "[";
                    foreach (var item in Items)
                    {
                        to.Append(opening);
                        item.Write(to);
                        opening = ",";
                    }
                    to.Append(opening == "[" ? "[]" : "]");
                    break;
                default:
                    var separator = '{';
                    foreach (var entry in Entries)
                    {
                        WriteKey(entry.Key, ref separator, to);
                        entry.Value.Write(to);
                    }
                    to.Append(separator == '{' ? "{}" : "}");
                    break;
            }
        }

        internal static void WriteKey(string key, ref char separator, Output to)
        {
            to.Append(separator);
            separator = ',';
            WriteText(key, to);
            to.Append(':');
        }

        /// <summary>
        /// Appends a text in quotes. A kept half of a surrogate pair is escaped: UTF-8 has no bytes for it.
        /// </summary>
        internal static void WriteText(string text, Output to)
        {
            to.Append('"');
            for (var at = 0; at < text.Length; at++)
            {
                var unit = text[at];
                if (unit == '"' || unit == '\\')
                {
                    to.Append('\\').Append(unit);
                }
                else if (unit < ' ' || IsHalf(text, at))
                {
                    to.Append("\\u").Append(((int)unit).ToString("x4", CultureInfo.InvariantCulture));
                }
                else
                {
                    to.Append(unit);
                }
            }
            to.Append('"');
        }

        /// <summary>Returns <c>true</c> if a text has half of a surrogate pair, so it is not Unicode.</summary>
        internal static bool HasHalf(string text)
        {
            for (var at = 0; at < text.Length; at++)
            {
                if (IsHalf(text, at))
                {
                    return true;
                }
            }
            return false;
        }

        private static bool IsHalf(string text, int at)
        {
            if (char.IsHighSurrogate(text[at]))
            {
                return at + 1 == text.Length || !char.IsLowSurrogate(text[at + 1]);
            }
            return char.IsLowSurrogate(text[at]) && (at == 0 || !char.IsHighSurrogate(text[at - 1]));
        }
    }

    /// <summary>Text under construction, to be sent or for logs.</summary>
    internal sealed class Output
    {
        private readonly StringBuilder text = new StringBuilder();

        internal Output(bool isForLogs = false)
        {
            IsForLogs = isForLogs;
        }

        /// <c>true</c> to leave out sensitive values, and to skip checks.
        internal bool IsForLogs { get; }

        internal Output Append(string more)
        {
            text.Append(more);
            return this;
        }

        internal Output Append(char more)
        {
            text.Append(more);
            return this;
        }

        public override string ToString()
        {
            return text.ToString();
        }
    }

    /// <summary>Reads strict JSON (RFC 8259), with a limit on nesting.</summary>
    internal sealed class JsonReader
    {
        private readonly string text;
        private readonly int most;
        private int at;
        private int depth;

        internal JsonReader(string text, int most)
        {
            this.text = text;
            this.most = most;
        }

        internal Json Whole()
        {
            Space();
            var value = Value();
            Space();
            return at == text.Length ? value : throw Bad("more behind the value");
        }

        /// <summary>The present UTF-16 unit; at the end 0, which JSON allows only in strings.</summary>
        private char Here => at < text.Length ? text[at] : '\0';

        private Fault Bad(string detail)
        {
            return new Fault(Faults.BadJson, detail + ", at character " + at);
        }

        private void Space()
        {
            while (Here == ' ' || Here == '\t' || Here == '\n' || Here == '\r')
            {
                at++;
            }
        }

        private bool Next(char wanted)
        {
            if (Here != wanted)
            {
                return false;
            }
            at++;
            return true;
        }

        private Json Value()
        {
            switch (Here)
            {
                case '{':
                    return Object();
                case '[':
                    return List();
                case '"':
                    return new Json(Json.Kind.Text, String());
                case 'n':
                    return Word("null", Json.Kind.Null);
                case 't':
                    return Word("true", Json.Kind.True);
                case 'f':
                    return Word("false", Json.Kind.False);
                default:
                    return Number();
            }
        }

        private Json Word(string word, Json.Kind kind)
        {
            if (string.CompareOrdinal(text, at, word, 0, word.Length) != 0)
            {
                throw Bad("no value");
            }
            at += word.Length;
            return new Json(kind);
        }

        private void Open()
        {
            if (++depth > most)
            {
                throw new Fault(Faults.TooDeep, "nested deeper than " + most + " levels");
            }
            at++;
            Space();
        }

        private Json Object()
        {
            Open();
            var read = new Json(Json.Kind.Object);
            if (!Next('}'))
            {
                do
                {
                    Space();
                    var key = Here == '"' ? String() : throw Bad("a key is wanted");
                    Space();
                    if (!Next(':'))
                    {
                        throw Bad("a colon is wanted");
                    }
                    Space();
                    read.Entries.Add(new KeyValuePair<string, Json>(key, Value()));
                    Space();
                }
                while (Next(','));
                if (!Next('}'))
                {
                    throw Bad("`,` or `}` is wanted");
                }
            }
            depth--;
            return read;
        }

        private Json List()
        {
            Open();
            var read = new Json(Json.Kind.List);
            if (!Next(']'))
            {
                do
                {
                    Space();
                    read.Items.Add(Value());
                    Space();
                }
                while (Next(','));
                if (!Next(']'))
                {
                    throw Bad("`,` or `]` is wanted");
                }
            }
            depth--;
            return read;
        }

        private Json Number()
        {
            var end = Numbers.End(text, at);
            if (end == at)
            {
                throw Bad("no value");
            }
            var spelled = text.Substring(at, end - at);
            at = end;
            return new Json(Json.Kind.Number, spelled);
        }

        private string String()
        {
            var read = new StringBuilder();
            for (at++; Here != '"'; at++)
            {
                if (Here < ' ')
                {
                    throw Bad(at < text.Length ? "a control character in a string" : "a string does not end");
                }
                read.Append(Here == '\\' ? Escaped() : Here);
            }
            at++;
            return read.ToString();
        }

        /// <summary>Returns the unit of an escape, and stops at its last character.</summary>
        private char Escaped()
        {
            at++;
            var which = "\"\\/bfnrt".IndexOf(Here);
            if (which >= 0)
            {
                return "\"\\/\b\f\n\r\t"[which];
            }
            if (Here != 'u' || at + 4 >= text.Length)
            {
                throw Bad("an unknown escape");
            }
            var unit = 0;
            for (var digit = 0; digit < 4; digit++)
            {
                at++;
                var value = Numbers.HexDigit(Here);
                unit = value < 0 ? throw Bad("four hexadecimal digits are wanted") : unit * 16 + value;
            }
            return (char)unit;
        }
    }
}
