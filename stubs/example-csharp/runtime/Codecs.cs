using System;
using System.Collections.Generic;
using System.Globalization;

namespace FcRuntime
{
    /// <summary>Reads and writes the values of a type.</summary>
    public abstract class Codec<T>
    {
        /// <summary>Returns the value of JSON, or throws <see cref="Fault"/>.</summary>
        internal abstract T Read(Json json);

        /// <summary>Appends a value, or throws <see cref="Fault"/>.</summary>
        internal abstract void Write(T value, Output to);

        /// <summary>Checks a value against a constraint of its field. A list checks its items.</summary>
        internal virtual void Check(T value, Constraint constraint)
        {
            constraint.Ask(value);
        }
    }

    /// <summary>The form of a number or bool in JSON.</summary>
    public enum Form
    {
        /// <summary>The form of its type.</summary>
        Plain,

        /// <summary>Inside a JSON string.</summary>
        String,

        /// <summary>A bool as 1 or 0.</summary>
        Number
    }

    /// <summary>The codecs of all types in the spec language.</summary>
    public static class Codecs
    {
        /// <summary>
        /// Integers, each type with its range. A lenient number may be in a string, and in hexadecimal.
        /// </summary>
        public static Codec<sbyte> I8(Form form = Form.Plain, bool lenient = false) =>
            new Integers<sbyte>(sbyte.MinValue, sbyte.MaxValue, v => (sbyte)v, v => v, form, lenient);

        /// <inheritdoc cref="I8"/>
        public static Codec<short> I16(Form form = Form.Plain, bool lenient = false) =>
            new Integers<short>(short.MinValue, short.MaxValue, v => (short)v, v => v, form, lenient);

        /// <inheritdoc cref="I8"/>
        public static Codec<int> I32(Form form = Form.Plain, bool lenient = false) =>
            new Integers<int>(int.MinValue, int.MaxValue, v => (int)v, v => v, form, lenient);

        /// <inheritdoc cref="I8"/>
        public static Codec<long> I64(Form form = Form.Plain, bool lenient = false) =>
            new Integers<long>(long.MinValue, long.MaxValue, v => (long)v, v => v, form, lenient);

        /// <inheritdoc cref="I8"/>
        public static Codec<byte> U8(Form form = Form.Plain, bool lenient = false) =>
            new Integers<byte>(byte.MinValue, byte.MaxValue, v => (byte)v, v => v, form, lenient);

        /// <inheritdoc cref="I8"/>
        public static Codec<ushort> U16(Form form = Form.Plain, bool lenient = false) =>
            new Integers<ushort>(ushort.MinValue, ushort.MaxValue, v => (ushort)v, v => v, form, lenient);

        /// <inheritdoc cref="I8"/>
        public static Codec<uint> U32(Form form = Form.Plain, bool lenient = false) =>
            new Integers<uint>(uint.MinValue, uint.MaxValue, v => (uint)v, v => v, form, lenient);

        /// <inheritdoc cref="I8"/>
        public static Codec<ulong> U64(Form form = Form.Plain, bool lenient = false) =>
            new Integers<ulong>(ulong.MinValue, ulong.MaxValue, v => (ulong)v, v => v, form, lenient);

        /// <summary>32-bit floats.</summary>
        public static Codec<float> F32(Form form = Form.Plain, bool lenient = false) =>
            new Floats<float>(Numbers.Single, Numbers.Spell, v => float.IsNaN(v) || float.IsInfinity(v), form, lenient);

        /// <summary>64-bit floats.</summary>
        public static Codec<double> F64(Form form = Form.Plain, bool lenient = false) =>
            new Floats<double>(Numbers.Double, Numbers.Spell, v => double.IsNaN(v) || double.IsInfinity(v), form, lenient);

        /// <summary>Bools. A lenient one may have any form.</summary>
        public static Codec<bool> Bool(Form form = Form.Plain, bool lenient = false) => new Bools(form, lenient);

        /// <summary>Texts.</summary>
        public static Codec<string> Text { get; } = new Texts();

        /// <summary>Bytes, as padded base64 of the standard alphabet.</summary>
        public static Codec<byte[]> Base64 { get; } = new Base64();

        /// <summary>Any JSON, with its spelling.</summary>
        public static Codec<Json> Any { get; } = new Anything();

        /// <summary>Lists.</summary>
        public static Codec<IList<T>> List<T>(Codec<T> item) => new Lists<T>(item);

        /// <summary>
        /// Enums: the value of each constant in JSON, and the known values. A closed enum takes no others.
        /// </summary>
        public static Codec<E> Enum<E, W>(Codec<W> wire, Func<W, E> of, Func<E, W> to, bool isClosed, params W[] known) =>
            new Enums<E, W>(wire, of, to, isClosed, known);

        /// <summary>Objects. Their shape is looked up on use, since it may be created later.</summary>
        public static Codec<T> Object<T>(Func<Shape<T>> shape) where T : Message => new Objects<T>(shape);

        /// <summary>Choices: the first form whose required keys are all present applies.</summary>
        public static Codec<T> Choice<T>(params Func<Shape>[] variants) where T : class => new Choices<T>(variants);
    }

    internal abstract class Numeric<T> : Codec<T>
    {
        private readonly Form form;
        private readonly bool lenient;

        internal Numeric(Form form, bool lenient)
        {
            this.form = form;
            this.lenient = lenient;
        }

        /// <summary>Returns the spelling of a number in the form of its field.</summary>
        private string Spelling(Json json)
        {
            if (json.Is == Json.Kind.Number && (lenient || form != Form.String))
            {
                return json.Spelled;
            }
            if (json.Is != Json.Kind.Text || !lenient && form != Form.String)
            {
                throw new Fault(Faults.WrongType, "a number is wanted");
            }
            var text = Texts.Checked(json);
            var hexadecimal = lenient ? Numbers.Hexadecimal(text) : null;
            if (hexadecimal > ulong.MaxValue)
            {
                throw new Fault(Faults.OutOfRange, "the number is too large");
            }
            if (hexadecimal == null && (text.Length == 0 || Numbers.End(text, 0) != text.Length))
            {
                throw new Fault(Faults.WrongType, "a number is wanted");
            }
            return hexadecimal?.ToString(CultureInfo.InvariantCulture) ?? text;
        }

        internal override T Read(Json json)
        {
            return Parse(Spelling(json));
        }

        internal override void Write(T value, Output to)
        {
            var quote = form == Form.String ? "\"" : "";
            to.Append(quote + Spell(value) + quote);
        }

        protected abstract T Parse(string text);

        protected abstract string Spell(T value);
    }

    internal sealed class Integers<T> : Numeric<T>
    {
        private readonly decimal low;
        private readonly decimal high;
        private readonly Func<decimal, T> of;
        private readonly Func<T, decimal> to;

        internal Integers(decimal low, decimal high, Func<decimal, T> of, Func<T, decimal> to, Form form, bool lenient)
            : base(form, lenient)
        {
            this.low = low;
            this.high = high;
            this.of = of;
            this.to = to;
        }

        protected override T Parse(string text)
        {
            var value = Numbers.Integral(text);
            if (value == null)
            {
                throw new Fault(Faults.WrongType, "an integer is wanted");
            }
            if (value < low || value > high)
            {
                throw new Fault(Faults.OutOfRange, "the number must be within " + low + " … " + high);
            }
            return of(value.Value);
        }

        protected override string Spell(T value)
        {
            return to(value).ToString(CultureInfo.InvariantCulture);
        }

        internal override void Check(T value, Constraint constraint)
        {
            constraint.Ask(to(value));
        }
    }

    internal sealed class Floats<T> : Numeric<T> where T : struct
    {
        private readonly Func<string, T?> parse;
        private readonly Func<T, string> spell;
        private readonly Func<T, bool> isNoNumber;

        internal Floats(Func<string, T?> parse, Func<T, string> spell, Func<T, bool> isNoNumber, Form form, bool lenient)
            : base(form, lenient)
        {
            this.parse = parse;
            this.spell = spell;
            this.isNoNumber = isNoNumber;
        }

        protected override T Parse(string text)
        {
            return parse(text) ?? throw new Fault(Faults.OutOfRange, "the number is too large for its type");
        }

        protected override string Spell(T value)
        {
            return isNoNumber(value) ? throw new Fault(Faults.OutOfRange, "JSON has no such number") : spell(value);
        }

        internal override void Check(T value, Constraint constraint)
        {
            constraint.Ask(Convert.ToDouble(value, CultureInfo.InvariantCulture));
        }
    }

    internal sealed class Bools : Codec<bool>
    {
        private readonly Form form;
        private readonly bool lenient;

        internal Bools(Form form, bool lenient)
        {
            this.form = form;
            this.lenient = lenient;
        }

        internal override bool Read(Json json)
        {
            if ((json.Is == Json.Kind.True || json.Is == Json.Kind.False) && (lenient || form == Form.Plain))
            {
                return json.Is == Json.Kind.True;
            }
            var number = json.Is == Json.Kind.Number && (lenient || form == Form.Number) ? Numbers.Integral(json.Spelled) : null;
            if (number == 0 || number == 1)
            {
                return number == 1;
            }
            var text = json.Is == Json.Kind.Text && (lenient || form == Form.String) ? Texts.Checked(json) : null;
            return text == "true" || text == "false" ? text == "true" : throw new Fault(Faults.WrongType, "a bool is wanted");
        }

        internal override void Write(bool value, Output to)
        {
            var word = value ? "true" : "false";
            to.Append(form == Form.Plain ? word : form == Form.String ? '"' + word + '"' : value ? "1" : "0");
        }
    }

    internal sealed class Texts : Codec<string>
    {
        /// <summary>Returns the content of a string. Half of a surrogate pair is an error.</summary>
        internal static string Checked(Json json)
        {
            if (json.Is != Json.Kind.Text)
            {
                throw new Fault(Faults.WrongType, "a text is wanted");
            }
            return Checked(json.Spelled);
        }

        internal static string Checked(string text)
        {
            return Json.HasHalf(text) ? throw new Fault(Faults.LoneSurrogate, "half a surrogate pair is no text") : text;
        }

        internal override string Read(Json json)
        {
            return Checked(json);
        }

        internal override void Write(string value, Output to)
        {
            Json.WriteText(Checked(value), to);
        }
    }

    internal sealed class Base64 : Codec<byte[]>
    {
        internal override byte[] Read(Json json)
        {
            var text = Texts.Checked(json);
            try
            {
                var bytes = Convert.FromBase64String(text);
                // The library ignores white space and spare bits.
                if (Convert.ToBase64String(bytes) == text)
                {
                    return bytes;
                }
            }
            catch (FormatException)
            {
                // The error is thrown below.
            }
            throw new Fault(Faults.BadBase64, "padded base64 of the standard alphabet is wanted");
        }

        internal override void Write(byte[] value, Output to)
        {
            to.Append('"').Append(Convert.ToBase64String(value)).Append('"');
        }
    }

    internal sealed class Anything : Codec<Json>
    {
        internal override Json Read(Json json)
        {
            return json;
        }

        internal override void Write(Json value, Output to)
        {
            value.Write(to);
        }
    }

    internal sealed class Lists<T> : Codec<IList<T>>
    {
        private readonly Codec<T> item;

        internal Lists(Codec<T> item)
        {
            this.item = item;
        }

        internal override IList<T> Read(Json json)
        {
            if (json.Is != Json.Kind.List)
            {
                throw new Fault(Faults.WrongType, "a list is wanted");
            }
            var read = new List<T>(json.Items.Count);
            foreach (var one in json.Items)
            {
                try
                {
                    read.Add(item.Read(one));
                }
                catch (Fault fault)
                {
                    throw fault.Inside(read.Count);
                }
            }
            return read;
        }

        internal override void Write(IList<T> value, Output to)
        {
            to.Append('[');
            for (var index = 0; index < value.Count; index++)
            {
                try
                {
                    if (value[index] == null)
                    {
                        throw new Fault(Faults.WrongType, "no item of a list is null");
                    }
                    item.Write(value[index], index == 0 ? to : to.Append(','));
                }
                catch (Fault fault)
                {
                    throw fault.Inside(index);
                }
            }
            to.Append(']');
        }

        internal override void Check(IList<T> value, Constraint constraint)
        {
            if (constraint.IsOfTheWhole)
            {
                constraint.Ask(value.Count);
                return;
            }
            foreach (var one in value)
            {
                item.Check(one, constraint);
            }
        }
    }

    internal sealed class Enums<E, W> : Codec<E>
    {
        private readonly Codec<W> wire;
        private readonly Func<W, E> of;
        private readonly Func<E, W> to;
        private readonly HashSet<W> known;

        internal Enums(Codec<W> wire, Func<W, E> of, Func<E, W> to, bool isClosed, W[] known)
        {
            this.wire = wire;
            this.of = of;
            this.to = to;
            this.known = isClosed ? new HashSet<W>(known) : null;
        }

        internal override E Read(Json json)
        {
            return of(Checked(wire.Read(json)));
        }

        internal override void Write(E value, Output text)
        {
            wire.Write(Checked(to(value)), text);
        }

        internal override void Check(E value, Constraint constraint)
        {
            wire.Check(to(value), constraint);
        }

        private W Checked(W value)
        {
            if (known != null && !known.Contains(value))
            {
                throw new Fault(Faults.UnknownValue, "`" + value + "` is none of the values of this field");
            }
            return value;
        }
    }
}
