using System;
using System.Linq;
using System.Text.RegularExpressions;

namespace FcRuntime
{
    /// <summary>
    /// A constraint of a field on its values, in addition to the type. It is checked after reading the whole object,
    /// and before writing it.
    /// </summary>
    public sealed class Constraint
    {
        private readonly string fault;
        private readonly string wanted;
        private readonly Func<object, bool> holds;

        private Constraint(string fault, string wanted, Func<object, bool> holds, bool isOfTheWhole = false)
        {
            this.fault = fault;
            this.wanted = wanted;
            this.holds = holds;
            IsOfTheWhole = isOfTheWhole;
        }

        /// <c>true</c> if it applies to a list itself, not to its items.
        internal bool IsOfTheWhole { get; }

        /// <summary>
        /// Throws <see cref="Fault"/> if a value breaks the constraint. The value is a number, a text, bytes, or the
        /// length of a list.
        /// </summary>
        internal void Ask(object value)
        {
            if (!holds(value))
            {
                throw new Fault(fault, wanted);
            }
        }

        internal static Constraint Within(decimal? least, decimal? most)
        {
            return new Constraint(Faults.OutOfRange, Range(least, most), value =>
                (least == null || (decimal)value >= least) && (most == null || (decimal)value <= most));
        }

        internal static Constraint Between(double? least, double? most)
        {
            return new Constraint(Faults.OutOfRange, Range(least, most), value =>
                (least == null || (double)value >= least) && (most == null || (double)value <= most));
        }

        private static string Range(object least, object most)
        {
            return "the number must be within " + (least ?? "−∞") + " … " + (most ?? "∞");
        }

        internal static Constraint Length(long least, long most)
        {
            return new Constraint(Faults.BadLength, "the length must be within " + least + " … " + most, value =>
            {
                var found = value is int ? (int)value : value is byte[] ? ((byte[])value).Length : Characters((string)value);
                return found >= least && found <= most;
            }, true);
        }

        internal static Constraint Pattern(string pattern)
        {
            // In this mode `\d` and similar classes match only ASCII, as in the spec.
            var whole = new Regex("^(?:" + pattern + ")(?!\n)$", RegexOptions.ECMAScript);
            var wanted = "the text must match `" + pattern + "` as a whole";
            return new Constraint(Faults.BadPattern, wanted, value => whole.IsMatch((string)value));
        }

        internal static Constraint Only(object[] values)
        {
            var wanted = "the value must be one of: " + string.Join(", ", values);
            return new Constraint(Faults.OutOfRange, wanted, value => values.Contains(value));
        }

        /// <summary>Returns the number of Unicode characters in a text: a surrogate pair is one.</summary>
        private static int Characters(string text)
        {
            return text.Count(unit => !char.IsLowSurrogate(unit));
        }
    }
}
