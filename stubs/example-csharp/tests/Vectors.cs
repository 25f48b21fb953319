using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using Fc;
using FcRuntime;

namespace FcTests
{
    /// <summary>
    /// All golden frames: accepted ones are read with their type and written again, rejected ones give the error's
    /// name.
    /// </summary>
    internal static class Vectors
    {
        internal static void Run(string directory, Report report)
        {
            var missing = new HashSet<string>(Operations.All.Select(operation => operation.Name));
            foreach (var path in Directory.GetFiles(directory, "*.json").OrderBy(path => path, StringComparer.Ordinal))
            {
                var file = Given.Read(path);
                var name = Path.GetFileNameWithoutExtension(path);
                if (name == "frames")
                {
                    Frames(file, report);
                }
                else if (name == "bodies")
                {
                    BodiesOfOneKey.Run(file, report);
                }
                else
                {
                    var operation = Operations.All.Single(one => one.Name == file.Get("operation").Spelled);
                    missing.Remove(operation.Name);
                    Messages(name, operation, file, report);
                }
            }
            report.Case(null, "each operation has vectors", "", () => string.Join(", ", missing));
        }

        private static void Messages(string file, Operation operation, Json vectors, Report report)
        {
            foreach (var vector in vectors.Get("accepted").Items)
            {
                var name = file + " accepted " + vector.Get("name").Spelled;
                var data = vector.Get("data");
                var wanted = vector.Get("canonical") ?? vector.Get("body");
                report.Case("accepted", name, data?.Spelled ?? Given.Sorted(wanted), () =>
                {
                    var again = Again(operation, vector);
                    return data == null ? Given.Sorted(Json.ParseBody(again, Wire.Layout.JsonDepth)) : Given.Hex(again);
                });
            }
            foreach (var vector in vectors.Get("rejected").Items)
            {
                var name = file + " rejected " + vector.Get("name").Spelled;
                report.Case("rejected", name, vector.Get("error").Spelled, () => Bodies.Utf8.GetString(Again(operation, vector)));
            }
        }

        /// <summary>Returns a message that was read with its type and written again.</summary>
        private static byte[] Again(Operation operation, Json vector)
        {
            var isResponse = vector.Get("direction").Spelled == "response";
            byte[] body;
            if (vector.Get("frame") == null)
            {
                body = Bodies.Utf8.GetBytes(vector.Get("text").Spelled);
            }
            else
            {
                var bytes = Given.Bytes(vector.Get("frame"));
                var frame = Frame.Decode(Wire.Layout, bytes);
                Given.Demand(frame.IsResponse == isResponse && frame.Code == operation.Code, "the header says something else");
                if (vector.Get("case")?.Spelled == "plain")
                {
                    Given.Demand(frame.Encode(Wire.Layout).SequenceEqual(bytes), "the frame is another when it is made again");
                }
                body = frame.Data;
            }
            var shape = isResponse ? operation.Response : operation.Request;
            if (operation.Kind == "stream")
            {
                return shape == null ? body : Bodies.Utf8.GetBytes(Bodies.Read(shape, body, Wire.Layout.JsonDepth).ToJson());
            }
            var envelope = isResponse ? (Shape)Shapes.ResponseEnvelope : Shapes.RequestEnvelope;
            var opened = Bodies.Read(envelope, shape, body, Wire.Layout.JsonDepth);
            Given.Demand(opened.Message.ToString().Length > 0, "a message has a text for logs");
            return Bodies.Write(opened.Envelope, opened.Message);
        }

        /// <summary>The frame format itself.</summary>
        private static void Frames(Json vectors, Report report)
        {
            foreach (var vector in vectors.Get("accepted").Items)
            {
                var header = vector.Get("header");
                var numbers = new[] { "kind", "code", "id" }.Select(role => header.Get(role)?.Spelled ?? "0");
                var wanted = string.Join(" ", vector.Get("direction").Spelled, string.Join(" ", numbers), vector.Get("data").Spelled);
                report.Case("frames", "frames accepted " + vector.Get("name").Spelled, wanted, () =>
                {
                    var frame = Frame.Decode(Wire.Layout, Given.Bytes(vector.Get("frame")));
                    foreach (var isPacked in new[] { false, Wire.Layout.Gzip != null })
                    {
                        var again = Frame.Decode(Wire.Layout, frame.Encode(Wire.Layout, isPacked));
                        Given.Demand(Said(again) == Said(frame), "the frame is another when it is made again");
                    }
                    return Said(frame);
                });
            }
            foreach (var vector in vectors.Get("rejected").Items)
            {
                var name = "frames rejected " + vector.Get("name").Spelled;
                report.Case("frames", name, vector.Get("error").Spelled, () => Said(Frame.Decode(Wire.Layout, Given.Bytes(vector.Get("frame")))));
            }
        }

        private static string Said(Frame frame)
        {
            return string.Join(" ", frame.IsResponse ? "response" : "request", frame.Kind, frame.Code, frame.Id, Given.Hex(frame.Data));
        }
    }

    /// <summary>Bodies at the edges of JSON, read as a message of one optional key.</summary>
    internal static class BodiesOfOneKey
    {
        private sealed class OfOneKey : Message
        {
            internal object Value;

            private readonly Shape shape;

            internal OfOneKey(Shape shape)
            {
                this.shape = shape;
            }

            internal override Shape ShapeOfThis => shape;
        }

        private static Shape Of<T>(Codec<T> codec)
        {
            Shape<OfOneKey> made = null;
            made = new Shape<OfOneKey>(() => new OfOneKey(made)).Optional("value", codec, m => (T)m.Value, (m, v) => m.Value = v, m => m.Value != null);
            return made;
        }

        private static readonly Dictionary<string, Shape> Types = new Dictionary<string, Shape>
        {
            { "i8", Of(Codecs.I8()) }, { "i16", Of(Codecs.I16()) }, { "i32", Of(Codecs.I32()) }, { "i64", Of(Codecs.I64()) },
            { "u8", Of(Codecs.U8()) }, { "u16", Of(Codecs.U16()) }, { "u32", Of(Codecs.U32()) }, { "u64", Of(Codecs.U64()) },
            { "f32", Of(Codecs.F32()) }, { "f64", Of(Codecs.F64()) }, { "timestamp_ms", Of(Codecs.I64()) }, { "timestamp_s", Of(Codecs.I64()) },
            { "string", Of(Codecs.Text) }, { "base64", Of(Codecs.Base64) }, { "json", Of(Codecs.Any) },
            { "object", Of(Codecs.Object(() => (Shape<OfOneKey>)Of(Codecs.I32()))) }
        };

        internal static void Run(Json vectors, Report report)
        {
            foreach (var list in new[] { "accepted", "rejected" })
            {
                foreach (var vector in vectors.Get(list).Items)
                {
                    var type = vector.Get("type").Spelled;
                    var isFloat = type == "f32" || type == "f64";
                    var wanted = list == "accepted" ? Said(vector.Get("written").Spelled, isFloat) : vector.Get("error").Spelled;
                    report.Case("bodies", "bodies " + list + " " + vector.Get("name").Spelled, wanted, () =>
                    {
                        var read = Bodies.Read(Types[type], Given.Bytes(vector.Get("bytes")), 64);
                        return Said(Bodies.Utf8.GetString(Bodies.Utf8.GetBytes(read.ToJson())), isFloat);
                    });
                }
            }
        }

        /// <summary>Returns the text with floats and string escapes in one spelling; all else must be equal.</summary>
        private static string Said(string text, bool isFloat)
        {
            var json = Json.Parse(text);
            return isFloat ? Given.Number(json.Get("value").Spelled) + (json.Get("value").Spelled[0] == '-') : json.ToString();
        }
    }
}
