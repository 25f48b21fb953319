using System;
using System.Collections.Generic;
using System.Linq;
using Fc;
using FcRuntime;

namespace FcTests
{
    /// <summary>The names of errors are those that all languages share.</summary>
    internal static class Names
    {
        internal static void Run(string path, Report report)
        {
            var ours = typeof(Faults).GetFields().Select(field => (string)field.GetRawConstantValue()).ToList();
            // A limit of only some implementations has a name, too.
            var shared = Given.Read(path).Get("errors").Items.Where(error => error.Get("where").Spelled != "call");
            var wanted = shared.Where(error => error.Get("own_limit") == null || ours.Contains(error.Get("name").Spelled));
            var names = string.Join(" ", wanted.Select(error => error.Get("name").Spelled));
            report.Case(null, "names of faults", names, () => string.Join(" ", ours));
            foreach (var error in wanted.Where(error => error.Get("own_limit") == null))
            {
                var name = error.Get("name").Spelled;
                report.Case(error.Get("where").Spelled + "_errors", "the fault " + name, name, () => ours.Find(one => one == name));
            }
        }
    }

    /// <summary>The first error of a body with several is reported, with its place.</summary>
    internal static class Order
    {
        internal static void Run(string path, Report report)
        {
            foreach (var fault in Given.Read(path).Get("faults").Items)
            {
                var operation = Operations.All.FirstOrDefault(one => one.Name == fault.Get("operation").Spelled);
                if (operation == null)
                {
                    continue; // Of another spec.
                }
                var place = fault.Get("path");
                report.Case("faults", "faults " + fault.Get("name").Spelled, fault.Get("error").Spelled + " " + place?.Spelled, () =>
                {
                    var isResponse = fault.Get("message").Spelled == "response";
                    var envelope = isResponse ? (Shape)Shapes.ResponseEnvelope : Shapes.RequestEnvelope;
                    try
                    {
                        var body = Bodies.Utf8.GetBytes(fault.Get("text").Spelled);
                        Bodies.Read(envelope, isResponse ? operation.Response : operation.Request, body, 64);
                        return "accepted";
                    }
                    catch (Fault found)
                    {
                        return found.Name + " " + (place == null ? null : found.Path);
                    }
                });
            }
        }
    }

    /// <summary>
    /// Decodes each frame, one in hex on a line, and prints the result as <c>fc-reflect/tests/it/judges.rs</c>
    /// describes.
    /// </summary>
    internal static class Judge
    {
        internal static void Run(System.IO.TextReader from, System.IO.TextWriter to)
        {
            string line;
            while ((line = from.ReadLine()) != null)
            {
                var answer = new Output();
                try
                {
                    Verdict(Given.Bytes(new Json(Json.Kind.Text, line)), answer);
                }
                catch (Fault fault)
                {
                    answer = new Output();
                    Texts(answer, "refused", fault.Name, fault.Path);
                    answer.Append(']');
                }
                to.WriteLine(answer);
            }
        }

        private static void Verdict(byte[] bytes, Output answer)
        {
            var frame = Frame.Decode(Wire.Layout, bytes);
            var kind = Wire.Layout.Kinds[frame.Kind];
            var header = string.Join(",", "", frame.IsResponse ? 1 : 0, frame.Kind, frame.Code, frame.Id) + ",";
            var operation = Operations.All.FirstOrDefault(one => one.Kind == kind && one.Code == frame.Code);
            string message = null;
            if (kind != "stream")
            {
                var envelope = frame.IsResponse ? (Shape)Shapes.ResponseEnvelope : Shapes.RequestEnvelope;
                var shape = frame.IsResponse ? operation?.Response : operation?.Request;
                var opened = Bodies.Read(envelope, shape ?? Nothing.Shape, frame.Data, Wire.Layout.JsonDepth);
                message = Bodies.Utf8.GetString(Bodies.Write(opened.Envelope, opened.Message));
            }
            // The body of an unknown operation is checked and returned unchanged.
            var isMessage = message != null && operation != null;
            Texts(answer, isMessage ? "message" : "bytes");
            answer.Append(header);
            Json.WriteText(isMessage ? message : Given.Hex(frame.Data), answer);
            answer.Append(']');
        }

        private static void Texts(Output answer, params string[] texts)
        {
            var separator = '[';
            foreach (var text in texts)
            {
                answer.Append(separator);
                separator = ',';
                Json.WriteText(text, answer);
            }
        }
    }
}
