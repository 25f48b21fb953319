using System.Collections.Generic;
using System.Linq;
using System.Text;

namespace FcRuntime
{
    /// <summary>An operation of the protocol, with the shapes of its two messages.</summary>
    public sealed class Operation
    {
        /// <summary>Creates an operation with its facts from the spec.</summary>
        public Operation(string name, string kind, uint? code, Shape request, Shape response)
        {
            Name = name;
            Kind = kind;
            Code = code;
            Request = request;
            Response = response;
        }

        /// <summary>Its name in the spec.</summary>
        public string Name { get; }

        /// <summary><c>command</c>, <c>report</c> or <c>stream</c>.</summary>
        public string Kind { get; }

        /// <summary>Its code; null if none is assigned.</summary>
        public uint? Code { get; }

        /// <summary>The request's shape; null for raw bytes.</summary>
        public Shape Request { get; }

        /// <summary>The shape of the response or acknowledgement; null for none.</summary>
        public Shape Response { get; }
    }

    /// <summary>An envelope and its message.</summary>
    public struct Opened<E, M>
    {
        /// <summary>The keys of every request, or of every response.</summary>
        public E Envelope;

        /// <summary>The message of the operation.</summary>
        public M Message;
    }

    /// <summary>Bodies: JSON text in UTF-8.</summary>
    public static class Bodies
    {
        /// <summary>UTF-8 without a byte order mark, for reading and writing.</summary>
        internal static readonly Encoding Utf8 = new UTF8Encoding(false, true);

        /// <summary>
        /// Reads a body. Throws <see cref="Fault"/>. An error of the envelope comes before one of the message.
        /// </summary>
        public static Opened<E, M> Read<E, M>(Shape<E> envelope, Shape<M> message, byte[] body, int depth) where E : Message where M : Message
        {
            var opened = Read((Shape)envelope, message, body, depth);
            return new Opened<E, M> { Envelope = (E)opened.Envelope, Message = (M)opened.Message };
        }

        /// <summary>Reads a body with types known only at run time.</summary>
        public static Opened<Message, Message> Read(Shape envelope, Shape message, byte[] body, int depth)
        {
            var json = Json.ParseBody(body, depth);
            var outer = envelope.Begin();
            var inner = message.Begin();
            Fault first = null;
            foreach (var entry in json.Entries)
            {
                Shape.CheckKey(entry.Key);
                if (outer.Knows(entry.Key))
                {
                    outer.Take(entry.Key, entry.Value);
                    continue;
                }
                try
                {
                    if (first == null)
                    {
                        inner.Take(entry.Key, entry.Value);
                    }
                }
                catch (Fault fault)
                {
                    first = fault;
                }
            }
            var opened = new Opened<Message, Message> { Envelope = outer.End() };
            if (first != null)
            {
                throw first;
            }
            opened.Message = inner.End();
            return opened;
        }

        /// <summary>Reads a body without an envelope.</summary>
        public static Message Read(Shape message, byte[] body, int depth)
        {
            return message.ReadObject(Json.ParseBody(body, depth));
        }

        /// <summary>Reads constants of the protocol from a JSON list.</summary>
        public static IReadOnlyList<T> Constants<T>(Shape<T> row, string json) where T : Message
        {
            return Json.Parse(json).Items.Select(row.Parse).ToList();
        }

        /// <summary>Writes an envelope and a message.</summary>
        public static byte[] Write(Message envelope, Message message)
        {
            var to = new Output();
            var separator = '{';
            envelope.ShapeOfThis.WriteKeys(envelope, to, ref separator);
            message.ShapeOfThis.WriteKeys(message, to, ref separator);
            to.Append(separator == '{' ? "{}" : "}");
            return Utf8.GetBytes(to.ToString());
        }
    }
}
