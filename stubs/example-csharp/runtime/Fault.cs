using System;

namespace FcRuntime
{
    /// <summary>The error of a frame or a body: a name shared by all languages, and a place.</summary>
    public sealed class Fault : Exception
    {
        /// <summary>Creates the error with a name of <see cref="Faults"/>. The path grows on the way out.</summary>
        public Fault(string name, string detail) : base(detail)
        {
            Name = name;
            Path = "";
        }

        /// <summary>The name, such as <c>out_of_range</c>.</summary>
        public string Name { get; }

        /// <summary>
        /// The keys down to the place, such as <c>data.stations[3].x</c>; empty for a frame and for the body itself.
        /// </summary>
        public string Path { get; private set; }

        /// <summary>Returns the same error, with its path prefixed by a key.</summary>
        public Fault Inside(string key)
        {
            var isWithin = Path.Length == 0 || Path[0] == '[';
            Path = key + (isWithin ? "" : ".") + Path;
            return this;
        }

        /// <summary>Returns the same error, with its path prefixed by an index.</summary>
        public Fault Inside(int index)
        {
            return Inside("[" + index + "]");
        }
    }

    /// <summary>The names of errors, as in <c>conformance/errors.json</c>.</summary>
    public static class Faults
    {
#pragma warning disable 1591 // Each says in conformance/errors.json what it means.
        public const string BadHead = "bad_head";
        public const string ShortFrame = "short_frame";
        public const string FrameTooLong = "frame_too_long";
        public const string Truncated = "truncated";
        public const string UnknownKind = "unknown_kind";
        public const string ReservedKind = "reserved_kind";
        public const string UnknownEncoding = "unknown_encoding";
        public const string BadDigest = "bad_digest";
        public const string BadGzip = "bad_gzip";
        public const string PlainLengthMismatch = "plain_length_mismatch";
        public const string InflatedTooLong = "inflated_too_long";
        public const string InflatesTooMuch = "inflates_too_much";
        public const string NotUtf8 = "not_utf8";
        public const string BadJson = "bad_json";
        public const string NotAnObject = "not_an_object";
        public const string WrongType = "wrong_type";
        public const string MissingField = "missing_field";
        public const string DuplicateKey = "duplicate_key";
        public const string LoneSurrogate = "lone_surrogate";
        public const string OutOfRange = "out_of_range";
        public const string BadLength = "bad_length";
        public const string BadPattern = "bad_pattern";
        public const string UnknownValue = "unknown_value";
        public const string NoVariant = "no_variant";
        public const string TooDeep = "too_deep";
        public const string BadBase64 = "bad_base64";
#pragma warning restore 1591
    }
}
