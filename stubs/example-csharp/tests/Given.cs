using System;
using System.Globalization;
using System.IO;
using System.Linq;
using FcRuntime;

namespace FcTests
{
    /// <summary>Reads the files of the vectors, and compares values.</summary>
    internal static class Given
    {
        internal static Json Read(string path)
        {
            return Json.Parse(File.ReadAllText(path));
        }

        /// <summary>Returns the value of a key; null for a missing key and for JSON's null.</summary>
        internal static Json Get(this Json json, string key)
        {
            var found = json.Entries.FirstOrDefault(entry => entry.Key == key).Value;
            return found == null || found.Is == Json.Kind.Null ? null : found;
        }

        internal static byte[] Bytes(Json hex)
        {
            return Enumerable.Range(0, hex.Spelled.Length / 2).Select(at => Convert.ToByte(hex.Spelled.Substring(2 * at, 2), 16)).ToArray();
        }

        internal static string Hex(byte[] bytes)
        {
            return string.Concat(bytes.Select(one => one.ToString("x2")));
        }

        internal static void Demand(bool holds, string what)
        {
            if (!holds)
            {
                throw new InvalidOperationException(what);
            }
        }

        /// <summary>
        /// Returns a text that is the same for equal values, with any order of keys and any spelling of numbers.
        /// </summary>
        internal static string Sorted(Json json)
        {
            switch (json.Is)
            {
                case Json.Kind.Number:
                    return Number(json.Spelled);
                case Json.Kind.List:
                    return "[" + string.Join(",", json.Items.Select(Sorted)) + "]";
                case Json.Kind.Object:
                    var entries = json.Entries.Select(entry => entry.Key + ":" + Sorted(entry.Value));
                    return "{" + string.Join(",", entries.OrderBy(entry => entry, StringComparer.Ordinal)) + "}";
                default:
                    return json.ToString();
            }
        }

        /// <summary>
        /// Returns an integer by its digits, and any other number by its nearest double, or by its spelling if it is
        /// too large.
        /// </summary>
        internal static string Number(string spelled)
        {
            var integral = Numbers.Integral(spelled);
            if (integral != null && Math.Abs(integral.Value) < decimal.MaxValue)
            {
                return integral.Value.ToString(CultureInfo.InvariantCulture);
            }
            var value = Numbers.Double(spelled);
            return value == null ? spelled : "bits " + BitConverter.DoubleToInt64Bits(value.Value);
        }
    }
}
