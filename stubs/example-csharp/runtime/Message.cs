using System;
using System.Collections.Generic;
using System.Linq;

namespace FcRuntime
{
    /// <summary>An object of the protocol.</summary>
    public abstract class Message
    {
        /// <summary>Keys that the protocol does not declare, in their order; kept, and sent again unchanged.</summary>
        public IList<KeyValuePair<string, Json>> Extra { get; internal set; } = new List<KeyValuePair<string, Json>>();

        internal abstract Shape ShapeOfThis { get; }

        /// <summary>Returns the compact JSON text. Throws <see cref="Fault"/> if a constraint does not hold.</summary>
        public string ToJson()
        {
            var to = new Output();
            ShapeOfThis.WriteObject(this, to);
            return to.ToString();
        }

        /// <summary>Returns JSON text for logs, without sensitive values and without checks.</summary>
        public override string ToString()
        {
            var to = new Output(true);
            try
            {
                ShapeOfThis.WriteObject(this, to);
            }
            catch (Fault fault)
            {
                to.Append("… (" + fault.Name + ")");
            }
            return to.ToString();
        }
    }

    /// <summary>A message without declared keys.</summary>
    public sealed class Nothing : Message
    {
        internal static readonly Shape<Nothing> Shape = new Shape<Nothing>(() => new Nothing());

        internal override Shape ShapeOfThis => Shape;
    }

    /// <summary>The fields of a type of messages, for any type.</summary>
    public abstract class Shape
    {
        internal abstract Reading Begin();

        internal abstract bool HasRequired(Json json);

        internal abstract void WriteKeys(Message message, Output to, ref char separator);

        internal void WriteObject(Message message, Output to)
        {
            var separator = '{';
            WriteKeys(message, to, ref separator);
            to.Append(separator == '{' ? "{}" : "}");
        }

        internal Message ReadObject(Json json)
        {
            if (json.Is != Json.Kind.Object)
            {
                throw new Fault(Faults.WrongType, "an object is wanted");
            }
            var reading = Begin();
            foreach (var entry in json.Entries)
            {
                CheckKey(entry.Key);
                reading.Take(entry.Key, entry.Value);
            }
            return reading.End();
        }

        /// <summary>Checks a key's text, declared or not.</summary>
        internal static void CheckKey(string key)
        {
            Texts.Checked(key);
        }
    }

    /// <summary>A message being read, key by key.</summary>
    internal abstract class Reading
    {
        internal abstract bool Knows(string key);

        internal abstract void Take(string key, Json json);

        /// <summary>Returns the message. Checks for missing fields and broken constraints.</summary>
        internal abstract Message End();
    }

    /// <summary>The fields of a type of messages, as the source of its reader, writer and constraints.</summary>
    public sealed class Shape<T> : Shape where T : Message
    {
        private readonly Func<T> make;
        private readonly List<Field<T>> fields = new List<Field<T>>();
        private readonly Dictionary<string, int> byKey = new Dictionary<string, int>(StringComparer.Ordinal);

        internal Shape(Func<T> make)
        {
            this.make = make;
        }

        internal Shape<T> Required<V>(string key, Codec<V> codec, Func<T, V> get, Action<T, V> set, Func<T, bool> isThere = null)
        {
            return With(new Field<T, V>(key, true, codec, get, set, isThere ?? (_ => true)));
        }

        internal Shape<T> Optional<V>(string key, Codec<V> codec, Func<T, V> get, Action<T, V> set, Func<T, bool> isThere)
        {
            return With(new Field<T, V>(key, false, codec, get, set, isThere));
        }

        private Shape<T> With(Field<T> field)
        {
            byKey.Add(field.Key, fields.Count);
            fields.Add(field);
            return this;
        }

        private Field<T> Last => fields[fields.Count - 1];

        /// <summary>Adds another key that the last field accepts.</summary>
        internal Shape<T> Also(string key)
        {
            byKey.Add(key, fields.Count - 1);
            return this;
        }

        internal Shape<T> EmptyIsAbsent()
        {
            Last.IsAbsentIfEmpty = true;
            return this;
        }

        internal Shape<T> Sensitive()
        {
            Last.IsSensitive = true;
            return this;
        }

        internal Shape<T> Within(decimal? least, decimal? most)
        {
            return With(Constraint.Within(least, most));
        }

        internal Shape<T> Between(double? least, double? most)
        {
            return With(Constraint.Between(least, most));
        }

        internal Shape<T> Length(long least, long most)
        {
            return With(Constraint.Length(least, most));
        }

        internal Shape<T> Pattern(string pattern)
        {
            return With(Constraint.Pattern(pattern));
        }

        internal Shape<T> Only(params object[] values)
        {
            return With(Constraint.Only(values));
        }

        private Shape<T> With(Constraint constraint)
        {
            Last.Constraints.Add(constraint);
            return this;
        }

        /// <summary>Reads an object. Throws <see cref="Fault"/>.</summary>
        public T Parse(Json json)
        {
            return (T)ReadObject(json);
        }

        internal override bool HasRequired(Json json)
        {
            var there = new HashSet<int>();
            foreach (var entry in json.Entries)
            {
                int field;
                if (byKey.TryGetValue(entry.Key, out field))
                {
                    there.Add(field);
                }
            }
            return Enumerable.Range(0, fields.Count).All(field => !fields[field].IsRequired || there.Contains(field));
        }

        internal override void WriteKeys(Message message, Output to, ref char separator)
        {
            var written = (T)message;
            foreach (var field in fields)
            {
                field.Write(written, to, ref separator);
            }
            foreach (var entry in message.Extra)
            {
                if (byKey.ContainsKey(entry.Key) && !to.IsForLogs)
                {
                    throw new Fault(Faults.DuplicateKey, "the type has a field for this key").Inside(entry.Key);
                }
                Json.WriteKey(entry.Key, ref separator, to);
                entry.Value.Write(to);
            }
        }

        internal override Reading Begin()
        {
            return new ReadingOf(this);
        }

        private sealed class ReadingOf : Reading
        {
            private readonly Shape<T> shape;
            private readonly T message;
            private readonly bool[] seen;

            internal ReadingOf(Shape<T> shape)
            {
                this.shape = shape;
                message = shape.make();
                seen = new bool[shape.fields.Count];
            }

            internal override bool Knows(string key)
            {
                return shape.byKey.ContainsKey(key);
            }

            internal override void Take(string key, Json json)
            {
                int index;
                if (!shape.byKey.TryGetValue(key, out index))
                {
                    message.Extra.Add(new KeyValuePair<string, Json>(key, json));
                    return;
                }
                if (seen[index])
                {
                    throw new Fault(Faults.DuplicateKey, "the key comes twice").Inside(key);
                }
                seen[index] = true;
                try
                {
                    shape.fields[index].Read(message, json);
                }
                catch (Fault fault)
                {
                    throw fault.Inside(key);
                }
            }

            internal override Message End()
            {
                for (var index = 0; index < seen.Length; index++)
                {
                    if (!seen[index] && shape.fields[index].IsRequired)
                    {
                        throw shape.fields[index].Missing();
                    }
                }
                foreach (var field in shape.fields)
                {
                    field.Check(message);
                }
                return message;
            }
        }
    }

    internal abstract class Field<T>
    {
        protected Field(string key, bool isRequired)
        {
            Key = key;
            IsRequired = isRequired;
        }

        internal string Key { get; }

        internal bool IsRequired { get; }

        internal bool IsAbsentIfEmpty { get; set; }

        internal bool IsSensitive { get; set; }

        internal List<Constraint> Constraints { get; } = new List<Constraint>();

        internal Fault Missing()
        {
            return new Fault(Faults.MissingField, "the key is required").Inside(Key);
        }

        internal abstract void Read(T message, Json json);

        internal abstract void Check(T message);

        internal abstract void Write(T message, Output to, ref char separator);
    }

    internal sealed class Field<T, V> : Field<T>
    {
        private readonly Codec<V> codec;
        private readonly Func<T, V> get;
        private readonly Action<T, V> set;
        private readonly Func<T, bool> isThere;

        internal Field(string key, bool isRequired, Codec<V> codec, Func<T, V> get, Action<T, V> set, Func<T, bool> isThere) : base(key, isRequired)
        {
            this.codec = codec;
            this.get = get;
            this.set = set;
            this.isThere = isThere;
        }

        internal override void Read(T message, Json json)
        {
            if (IsRequired || json.Is != Json.Kind.Null && !(IsAbsentIfEmpty && json.IsEmpty))
            {
                set(message, codec.Read(json));
            }
        }

        internal override void Check(T message)
        {
            if (Constraints.Count == 0 || !isThere(message))
            {
                return;
            }
            try
            {
                Constraints.ForEach(constraint => codec.Check(get(message), constraint));
            }
            catch (Fault fault)
            {
                throw fault.Inside(Key);
            }
        }

        internal override void Write(T message, Output to, ref char separator)
        {
            if (!isThere(message))
            {
                if (IsRequired && !to.IsForLogs)
                {
                    throw Missing();
                }
                return;
            }
            Json.WriteKey(Key, ref separator, to);
            if (to.IsForLogs && IsSensitive)
            {
                to.Append("\"…\"");
                return;
            }
            try
            {
                codec.Write(get(message), to);
            }
            catch (Fault fault)
            {
                throw fault.Inside(Key);
            }
            if (!to.IsForLogs)
            {
                Check(message);
            }
        }
    }

    internal sealed class Objects<T> : Codec<T> where T : Message
    {
        private readonly Func<Shape<T>> shape;

        internal Objects(Func<Shape<T>> shape)
        {
            this.shape = shape;
        }

        internal override T Read(Json json)
        {
            return shape().Parse(json);
        }

        internal override void Write(T value, Output to)
        {
            shape().WriteObject(value, to);
        }
    }

    internal sealed class Choices<T> : Codec<T> where T : class
    {
        private readonly Func<Shape>[] variants;

        internal Choices(Func<Shape>[] variants)
        {
            this.variants = variants;
        }

        internal override T Read(Json json)
        {
            if (json.Is != Json.Kind.Object)
            {
                throw new Fault(Faults.WrongType, "an object is wanted");
            }
            foreach (var entry in json.Entries)
            {
                Shape.CheckKey(entry.Key);
            }
            var first = variants.Select(variant => variant()).FirstOrDefault(shape => shape.HasRequired(json));
            return first == null ? throw new Fault(Faults.NoVariant, "none of the forms fits") : (T)(object)first.ReadObject(json);
        }

        internal override void Write(T value, Output to)
        {
            var message = (Message)(object)value;
            message.ShapeOfThis.WriteObject(message, to);
        }
    }
}
