using System.Collections.Generic;
using System.Linq;
using System.Text;

namespace FcRuntime
{
    /// <summary>An operation of the protocol, and what its two messages are.</summary>
    public sealed class Operation
    {
        /// <summary>What the spec says of it.</summary>
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

        /// <summary>Its code; null while nobody knows it.</summary>
        public uint? Code { get; }

        /// <summary>The message that opens it; null where that is raw bytes.</summary>
        public Shape Request { get; }

        /// <summary>The answer or acknowledgement; null where there is none.</summary>
        public Shape Response { get; }
    }

    /// <summary>A message and the keys beside it that every message has.</summary>
    public struct Opened<E, M>
    {
        /// <summary>The keys that every request, or every response, has.</summary>
        public E Envelope;

        /// <summary>The message of the operation.</summary>
        public M Message;
    }

    /// <summary>Bodies: JSON text in UTF-8.</summary>
    public static class Bodies
    {
        /// <summary>UTF-8 without a mark at the front, which neither reads nor writes anything else.</summary>
        internal static readonly Encoding Utf8 = new UTF8Encoding(false, true);

        /// <summary>
        /// Reads a body. Throws <see cref="Fault"/>; a fault of the envelope is named before one of the message.
        /// </summary>
        public static Opened<E, M> Read<E, M>(Shape<E> envelope, Shape<M> message, byte[] body, int depth) where E : Message where M : Message
        {
            var opened = Read((Shape)envelope, message, body, depth);
            return new Opened<E, M> { Envelope = (E)opened.Envelope, Message = (M)opened.Message };
        }

        /// <summary>The same where the types are known at run time alone.</summary>
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

        /// <summary>The message of a body that has no envelope.</summary>
        public static Message Read(Shape message, byte[] body, int depth)
        {
            return message.ReadObject(Json.ParseBody(body, depth));
        }

        /// <summary>Constants of the protocol, from the JSON of a list.</summary>
        public static IReadOnlyList<T> Constants<T>(Shape<T> row, string json) where T : Message
        {
            return Json.Parse(json).Items.Select(row.Parse).ToList();
        }

        /// <summary>The body of an envelope and the message beside it.</summary>
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
