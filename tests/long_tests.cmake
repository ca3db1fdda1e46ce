# Long tests, as a filter of gtest: the slowest tests of code that other tests also cover. ctest labels them
# `long`; `./test.sh` skips them, `./test.sh all` runs them.
set(long_tests
    All/ShaderVariants.ComputeItWithout* Bake.ErrorFalls* Bake.NumbersOfRays* *BakesTheLampsOfAScene/courtyard
    BelowTheZenith.IsDimmedByAll* BlockedCap.TakesThe* ColorBleeding.* Comparison.* Compress.TakesAllNumbers*
    All/DemoPictures.* CompressPredictors.ShaderOperations* *CompressedVolumes.ErrAs* CompressedVolumes.EvaluateWhat*
    *CompressedVolumes.OfFewDirections* Culling.NeverDrops* Diffusion.IsThatOf* Diffusion.OfAShadowsEdge*
    Diffusion.OfUniformLight* EndlessWall.* *ErrAsEstimated* ErrorBudget.OfBounces* *ErrsAsEstimated* FallbackRoad.*
    FigureTest.IsLitAs* FirstHour.SmallMeshes* FirstHour.UniformBlocks*
    FittedBake.BouncesAre* GpuRaster.Converges* GpuRaster.Peels* GpuSums.AreThose* GpuTrace.GivesTheSame*
    GpuTrace.HasCopies* IncidentReference.* Lamps.ThatAreSpheres* *LeadsFromSceneToPictures/1
    *LeadsFromSceneToPictures/2 *LeadsFromSceneToPictures/3 Levels.NearestPoints* LevelsOfDetail.AreBaked*
    Light.ConeAgrees* LightmapBake.BouncesAs* LightmapBake.ComesTo* LightmapScript.* LightmapViewer.BakesVertices*
    LightmapViewer.HasNumbers* LightmapViewer.PutsABake* LightmapViewer.ShowsVertices* Lightmaps.AreDecoded*
    LobesCommand.GivesTheSame* Make.Keeps* Make.SaysWhat* Make.TellsBounces* ManyReceivers.*
    OtherLayouts.NoiseIs* ParallelPlates.OneBounce*
    PathTracer.AgreesWith* PlainSkies.GiveNo* PlainSkies.HaveNo* RenderSuns.* Road.ADecoder* Road.AutomaticExposure*
    Road.BouncesOnTheGpu* Road.EveryView* SamplingError.* SceneLamps.TheBakers* Script.KeysAnd* Script.MeasuresWhere*
    Script.OpensWaits* Search.FindsOn* Search.IsMonotone* Search.IsNeverWorse* Search.Keeps* Search.LimitsJumps*
    Search.OperationsAlone* Search.Presets* Search.TakesAsLong* Search.WeightsThatAreNot*
    Skies/Suns.* Sky.AgreesWith* SphericalBowl.* Storage.* Subsurface.OfTheDensest* SunShadowPictures.AgreeWithRays*
    Suns.AndRemainder* Sweep.* TargetError.FindsTheWindow* TargetError.IsReached* TargetError.TakesFewer*
    Trace.NoCluster* ViewerPictures.OfSunsApart* ViewerTest.BakesWhatIsNot* ViewerTest.GivesSmall*
    ViewerTest.ListsEvery* ViewerTest.OpensCompressed* ViewerTest.PutsABake* ViewerTest.SaysWhereTransfer*
    VolumeBake.AFit*)
list(JOIN long_tests ":" long_tests)
