using System;
using System.Globalization;
using System.Numerics;

namespace FcRuntime
{
    /// <summary>Exact numbers of JSON: an integer in any spelling, and the nearest float of a type.</summary>
    internal static class Numbers
    {
        /// <summary>
        /// Greatest number of digits that matter. More digits only decide if a number is exactly half-way between two
        /// floats.
        /// </summary>
        private const int ManyDigits = 800;

        /// <summary>An exponent beyond all types. It may still follow a zero.</summary>
        private const int FarExponent = 100000;

        /// <summary>A number that no integer type has.</summary>
        private const decimal Far = decimal.MaxValue;

        internal static int HexDigit(char digit)
        {
            return digit > 'f' ? -1 : "0123456789abcdef".IndexOf(char.ToLowerInvariant(digit));
        }

        /// <summary>Returns the end of the number that begins here, or <c>start</c> if none does.</summary>
        internal static int End(string text, int start)
        {
            var at = start < text.Length && text[start] == '-' ? start + 1 : start;
            var whole = Digits(text, at);
            if (whole == at || text[at] == '0' && whole > at + 1)
            {
                // No digit may follow a leading zero; the reader reports it there.
                return whole == at ? start : at + 1;
            }
            at = whole;
            if (at < text.Length && text[at] == '.')
            {
                var part = Digits(text, at + 1);
                if (part == at + 1)
                {
                    return start;
                }
                at = part;
            }
            if (at < text.Length && (text[at] == 'e' || text[at] == 'E'))
            {
                var signed = at + 1 < text.Length && (text[at + 1] == '+' || text[at + 1] == '-') ? at + 2 : at + 1;
                var exponent = Digits(text, signed);
                return exponent == signed ? start : exponent;
            }
            return at;
        }

        private static int Digits(string text, int at)
        {
            while (at < text.Length && text[at] >= '0' && text[at] <= '9')
            {
                at++;
            }
            return at;
        }

        /// <summary>A number as its sign, its digits without zeros at either end, and a power of ten.</summary>
        private struct Parts
        {
            internal bool IsNegative;
            internal string Digits;
            internal int Power;

            internal static Parts Of(string text)
            {
                var parts = new Parts { IsNegative = text[0] == '-' };
                var end = text.IndexOfAny(new[] { 'e', 'E' });
                var mantissa = (end < 0 ? text : text.Substring(0, end)).TrimStart('-');
                var point = mantissa.IndexOf('.');
                var after = point < 0 ? 0 : mantissa.Length - point - 1;
                var all = mantissa.Replace(".", "").TrimStart('0');
                parts.Digits = all.TrimEnd('0');
                parts.Power = (end < 0 ? 0 : Exponent(text.Substring(end + 1))) - after + all.Length - parts.Digits.Length;
                return parts;
            }

            private static int Exponent(string text)
            {
                var digits = text.TrimStart('+', '-').TrimStart('0');
                var value = digits.Length > 5 ? FarExponent : digits.Length == 0 ? 0 : int.Parse(digits, CultureInfo.InvariantCulture);
                return text[0] == '-' ? -value : value;
            }
        }

        /// <summary>
        /// Returns the integer value of a number, or null for a fraction. A value beyond all types gives another one
        /// beyond all types.
        /// </summary>
        internal static decimal? Integral(string text)
        {
            var parts = Parts.Of(text);
            if (parts.Digits.Length == 0)
            {
                return 0;
            }
            if (parts.Power < 0)
            {
                return null;
            }
            var isFar = (long)parts.Digits.Length + parts.Power > 28;
            var value = isFar ? Far : decimal.Parse(parts.Digits + new string('0', parts.Power), CultureInfo.InvariantCulture);
            return parts.IsNegative ? -value : value;
        }

        /// <summary>Returns the number of a text <c>0x…</c>; null for any other text.</summary>
        internal static decimal? Hexadecimal(string text)
        {
            if (text.Length < 3 || text[0] != '0' || char.ToLowerInvariant(text[1]) != 'x')
            {
                return null;
            }
            decimal value = 0;
            for (var at = 2; at < text.Length; at++)
            {
                var digit = HexDigit(text[at]);
                if (digit < 0)
                {
                    return null;
                }
                value = value > ulong.MaxValue ? value : value * 16 + digit;
            }
            return value;
        }

        /// <summary>Returns the nearest double; null if the number is too large.</summary>
        internal static double? Double(string text)
        {
            var parts = Parts.Of(text);
            var bits = Nearest(parts, BitConverter.DoubleToInt64Bits(Guess(parts)), 52, 1023);
            if (bits == null)
            {
                return null;
            }
            var value = BitConverter.Int64BitsToDouble(bits.Value);
            return parts.IsNegative ? -value : value;
        }

        /// <summary>
        /// Returns the nearest 32-bit float; null if the number is too large. Through a double it would be rounded
        /// twice.
        /// </summary>
        internal static float? Single(string text)
        {
            var parts = Parts.Of(text);
            var guess = Math.Min(Guess(parts), float.MaxValue);
            var bits = Nearest(parts, BitConverter.ToInt32(BitConverter.GetBytes((float)guess), 0), 23, 127);
            if (bits == null)
            {
                return null;
            }
            var value = BitConverter.ToSingle(BitConverter.GetBytes((int)bits.Value), 0);
            return parts.IsNegative ? -value : value;
        }

        /// <summary>Returns a double nearby, perhaps with wrong last bits: not every library parses exactly.</summary>
        private static double Guess(Parts parts)
        {
            if (parts.Digits.Length == 0 || (long)parts.Digits.Length + parts.Power < -400)
            {
                return 0;
            }
            if ((long)parts.Digits.Length + parts.Power > 400)
            {
                return double.MaxValue;
            }
            var few = parts.Digits.Length > 20 ? parts.Digits.Substring(0, 20) : parts.Digits;
            var spelled = few + "E" + (parts.Power + parts.Digits.Length - few.Length);
            try
            {
                return Math.Min(double.Parse(spelled, NumberStyles.Float, CultureInfo.InvariantCulture), double.MaxValue);
            }
            catch (OverflowException)
            {
                return double.MaxValue;
            }
        }

        /// <summary>
        /// Returns the bits of the float nearest to a number without its sign, from a guess; null beyond the largest.
        /// </summary>
        private static long? Nearest(Parts parts, long guess, int fraction, int bias)
        {
            if (guess == 0 && (parts.Digits.Length == 0 || (long)parts.Digits.Length + parts.Power < -400))
            {
                return 0;
            }
            var beyond = (long)(2 * bias + 1) << fraction;
            if ((long)parts.Digits.Length + parts.Power > 400)
            {
                return null;
            }
            var power = parts.Power;
            var digits = parts.Digits;
            if (digits.Length > ManyDigits)
            {
                power += digits.Length - ManyDigits - 1;
                digits = digits.Substring(0, ManyDigits) + "1";
            }
            var exact = BigInteger.Parse(digits, CultureInfo.InvariantCulture);
            var bits = guess;
            while (bits < beyond && AgainstMiddle(exact, power, bits, fraction, bias) > 0)
            {
                bits++;
            }
            while (bits > 0 && AgainstMiddle(exact, power, bits - 1, fraction, bias) < 0)
            {
                bits--;
            }
            // Half-way between two floats, the even one is the result.
            if (bits < beyond && bits % 2 == 1 && AgainstMiddle(exact, power, bits, fraction, bias) == 0)
            {
                bits++;
            }
            else if (bits > 0 && bits % 2 == 1 && AgainstMiddle(exact, power, bits - 1, fraction, bias) == 0)
            {
                bits--;
            }
            return bits >= beyond ? (long?)null : bits;
        }

        /// <summary>Compares a number with the middle between the float of these bits and the next one.</summary>
        private static int AgainstMiddle(BigInteger digits, int power, long bits, int fraction, int bias)
        {
            var exponent = (int)(bits >> fraction);
            var mantissa = bits & (1L << fraction) - 1;
            if (exponent > 0)
            {
                mantissa |= 1L << fraction;
            }
            var two = Math.Max(exponent, 1) - bias - fraction - 1;
            var left = digits * BigInteger.Pow(10, Math.Max(power, 0)) * BigInteger.Pow(2, Math.Max(-two, 0));
            var right = new BigInteger(2 * mantissa + 1) * BigInteger.Pow(10, Math.Max(-power, 0)) * BigInteger.Pow(2, Math.Max(two, 0));
            return left.CompareTo(right);
        }

        /// <summary>Returns the shortest text that reads as this number.</summary>
        internal static string Spell(double value)
        {
            return Spell(value, 15, 17, text => Double(text) == Math.Abs(value));
        }

        /// <summary>Returns the shortest text that reads as this number.</summary>
        internal static string Spell(float value)
        {
            return Spell(value, 6, 9, text => Single(text) == Math.Abs(value));
        }

        private static string Spell(double value, int fewest, int most, Func<string, bool> isSame)
        {
            // Some libraries do not write the sign of negative zero.
            var sign = BitConverter.DoubleToInt64Bits(value) < 0 ? "-" : "";
            for (var digits = fewest; digits <= most; digits++)
            {
                var text = Math.Abs(value).ToString("G" + digits, CultureInfo.InvariantCulture);
                if (isSame(text) || digits == most)
                {
                    return sign + text;
                }
            }
            return sign;
        }
    }
}
