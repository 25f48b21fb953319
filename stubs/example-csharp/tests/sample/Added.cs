using Fc;

/// <summary>Uses the command that an owner has added.</summary>
public static class Added
{
    /// <summary>Returns a request and its text for logs.</summary>
    public static string Measure()
    {
        var request = new MeasureAddedRequest(AddedMode.Event, level: 3) { Word = "abc", Secret = new byte[] { 1 } };
        return Operations.MeasureAdded.Name + " " + request.ToJson() + " " + request;
    }

    /// <summary>Prints it.</summary>
    public static void Main()
    {
        System.Console.WriteLine(Measure());
    }
}
